//! Input files of CONTACT (Vollebregt, "CONTACT user guide", App. A): from their cases of modules 1, a wheel on a rail,
//! and 3, two bodies with a quadratic gap, to case files of half-spaces.
//!
//! What the digits and numbers of a case keep from the cases before it is kept here too. A digit without a meaning for half-spaces in
//! steady rolling is refused by its name and line; digits and numbers of solvers and output change no solution, and are passed over.

mod basic;
mod material;
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
}

/// The cases of an input file, or the `wanted` one alone, behind which nothing is read. `folder` is that of the file, to which the
/// names of profiles are relative.
///
/// # Errors
/// [`InpError`]: a line that does not follow the format, or says what half-spaces cannot.
pub fn inp_cases(
    text: &str,
    folder: &std::path::Path,
    wanted: Option<usize>,
) -> Result<Vec<InpCase>, InpError> {
    let mut reader = Reader::new(text);
    let (mut wheel_rail, mut basic) = (WheelRail::new(folder), Basic::default());
    let (mut cases, mut module, mut number) = (Vec::new(), 0, 0);
    while wanted != Some(number) && (module > 0 || !reader.is_at_end()) {
        if module == 0 {
            let group = reader.numbers(&["MODULE"], 2)?;
            if group.get(0) == 3.0 {
                module = 3;
            } else if group.get(0) == 0.0 {
                break;
            } else {
                let why = "only 1, a wheel on a rail, and 3, two bodies, are read";
                group.must_be("MODULE", 1.0, why)?;
                module = 1;
            }
        }
        number += 1;
        let (back, text) = match module {
            1 => wheel_rail.read(&mut reader)?,
            _ => basic.read(&mut reader)?,
        };
        back.one_of(&[0, 1, 2, 3])?;
        // 2 and 3 skip the case, 1 and 3 return to the choice of a module
        if back.value < 2 && wanted.is_none_or(|wanted| wanted == number) {
            cases.push(InpCase { number, text });
        }
        if back.value % 2 == 1 {
            module = 0;
        }
    }
    Ok(cases)
}

#[cfg(test)]
mod tests;
