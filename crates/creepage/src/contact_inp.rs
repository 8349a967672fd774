//! Input files of CONTACT (Vollebregt, "CONTACT user guide", App. A): from their cases to case files of half-spaces.
//!
//! A case of module 1 is a wheel on a rail, one of module 3 two bodies with a quadratic gap. What the digits and numbers of a case
//! keep from the cases before it is kept here too. A digit without a meaning for half-spaces in steady rolling is refused by its name
//! and line; digits and numbers of solvers and output change no solution, and are passed over.

mod basic;
mod reader;
mod wheel_rail;

pub use reader::InpError;

use basic::Basic;
use reader::Reader;
use wheel_rail::WheelRail;

/// A case of an input file.
#[derive(Clone, Debug, PartialEq)]
pub struct InpCase {
    /// Number of the case in the file, from 1.
    pub number: usize,
    /// The case file.
    pub text: String,
    /// What the case says in another way.
    pub notes: Vec<String>,
}

/// What all modules share: friction and material, which a case may keep.
#[derive(Clone, Copy, Debug, Default)]
struct Common {
    /// Coefficient of friction.
    mu: f64,
    /// Poisson's ratio, and shear modulus (Pa).
    poisson: f64,
    shear: f64,
}

impl Common {
    /// The lines of material and friction.
    fn lines(&self) -> String {
        let Self { mu, poisson, shear } = self;
        format!(
            "[material]\nyoung = {:?}\npoisson = {poisson:?}\n\n[friction]\nstatic = {mu:?}\n",
            2.0 * (1.0 + poisson) * shear
        )
    }

    /// Reads the friction of the law L, where V = 0.
    fn read_friction(&mut self, reader: &mut Reader<'_>, law: Digit) -> Result<(), InpError> {
        match law.value {
            0 => {
                let group = reader.numbers(&["FSTAT", "FKIN"], 0)?;
                group.same("FSTAT", "FKIN")?;
                self.mu = group.get(0);
                Ok(())
            }
            1 => Ok(()),
            _ => Err(law.refused("only 0 (Coulomb) and 1 (as before) are read")),
        }
    }

    /// Reads the material, where the digit C asks for it.
    fn read_material(&mut self, reader: &mut Reader<'_>, influence: Digit) -> Result<(), InpError> {
        if influence.value < 2 {
            return Ok(());
        }
        let group = reader.numbers(&["POISS1", "POISS2", "GG1", "GG2"], 0)?;
        group.same("POISS1", "POISS2")?;
        group.same("GG1", "GG2")?;
        (self.poisson, self.shear) = (group.get(0), 1e6 * group.get(2));
        Ok(())
    }
}

/// A control digit: its name, line and value.
#[derive(Clone, Copy, Debug, Default)]
struct Digit {
    name: &'static str,
    line: usize,
    value: u32,
}

impl Digit {
    fn refused(&self, why: &str) -> InpError {
        InpError::new(self.line, format!("{} = {}: {why}", self.name, self.value))
    }

    /// Refuses all values but those.
    fn one_of(&self, allowed: &[u32]) -> Result<(), InpError> {
        let listed: Vec<String> = allowed.iter().map(u32::to_string).collect();
        let why = format!("half-spaces in steady rolling need {}", listed.join(" or "));
        if allowed.contains(&self.value) { Ok(()) } else { Err(self.refused(&why)) }
    }
}

/// The digits of solver and output, HGIAOWR, and what follows of them.
fn read_solver(reader: &mut Reader<'_>, first: bool) -> Result<Digit, InpError> {
    const NAMES: [&str; 8] =
        ["XFLOW", "HEAT", "GAUSEI", "IESTIM", "MATFIL", "OUTPUT", "FLOW", "RETURN"];
    let [debug, heat, solver, .., back] = reader.digits(NAMES)?;
    heat.one_of(&[0])?;
    if debug.value == 1 {
        reader.numbers(&["PSFLCIN"], 1)?;
    }
    if solver.value != 1 || first {
        reader.numbers(&["MAXGS", "MAXIN", "MAXNR", "MAXOUT", "EPS"], 1)?;
    }
    match solver.value {
        0 | 1 => {}
        2 | 3 => drop(reader.numbers(&["OMEGAH", "OMEGAS", "INISLP", "OMGSLP"], 0)?),
        4 => drop(reader.numbers(&["INISLP", "OMGSLP"], 0)?),
        _ => return Err(solver.refused("this solver's numbers are not read")),
    }
    Ok(back)
}

/// The cases of an input file. `folder` is that of the file, to which the names of profiles are relative.
///
/// # Errors
/// [`InpError`]: a line that does not follow the format, or says what half-spaces cannot.
pub fn inp_cases(text: &str, folder: &std::path::Path) -> Result<Vec<InpCase>, InpError> {
    let mut reader = Reader::new(text);
    let (mut wheel_rail, mut basic) = (WheelRail::default(), Basic::default());
    let (mut cases, mut module, mut number) = (Vec::new(), 0, 0);
    while module > 0 || !reader.is_at_end() {
        let mut line = reader.line();
        if module == 0 {
            let group = reader.numbers(&["MODULE"], 2)?;
            (line, module) = (group.line, group.get(0) as u32);
        }
        number += 1;
        let (back, made) = match module {
            0 => break,
            1 => wheel_rail.read(&mut reader, folder)?,
            3 => basic.read(&mut reader)?,
            _ => {
                return Err(InpError::new(
                    line,
                    format!("MODULE = {module}: only 1 and 3 are read"),
                ));
            }
        };
        back.one_of(&[0, 1, 2, 3])?;
        let (text, notes) = made;
        // 2 and 3 skip the case
        if back.value < 2 {
            cases.push(InpCase { number, text, notes });
        }
        // 1 and 3 return to the choice of a module
        if back.value % 2 == 1 {
            module = 0;
        }
    }
    Ok(cases)
}

/// The text of a case, and its notes.
type Made = (String, Vec<String>);

#[cfg(test)]
mod tests;
