//! What cases of all modules read alike: solvers, friction, material.

use super::reader::{Digit, InpError, Reader};

/// What a case may keep of these from those before it.
#[derive(Debug, Default)]
pub(super) struct Material {
    read_before: bool,
    /// Coefficient of friction.
    pub(super) mu: f64,
    poisson: f64,
    /// Shear modulus (Pa).
    shear: f64,
}

impl Material {
    /// The digits of solver and output, and the numbers that follow of them; returns the digit RETURN.
    pub(super) fn read_solver(&mut self, reader: &mut Reader<'_>) -> Result<Digit, InpError> {
        let names = ["XFLOW", "HEAT", "GAUSEI", "IESTIM", "MATFIL", "OUTPUT", "FLOW", "RETURN"];
        let [debug, heat, solver, .., back] = reader.digits(names)?;
        heat.one_of(&[0])?;
        solver.one_of(&[0, 1, 2, 3, 4])?;
        if debug.value == 1 {
            reader.numbers(&["PSFLCIN"], 1)?;
        }
        if solver.value != 1 || !self.read_before {
            reader.numbers(&["MAXGS", "MAXIN", "MAXNR", "MAXOUT", "EPS"], 1)?;
        }
        self.read_before = true;
        match solver.value {
            2 | 3 => drop(reader.numbers(&["OMEGAH", "OMEGAS", "INISLP", "OMGSLP"], 0)?),
            4 => drop(reader.numbers(&["INISLP", "OMGSLP"], 0)?),
            _ => {}
        }
        Ok(back)
    }

    pub(super) fn read_friction(
        &mut self,
        reader: &mut Reader<'_>,
        law: Digit,
    ) -> Result<(), InpError> {
        if law.value == 0 {
            let friction = reader.numbers(&["FSTAT", "FKIN"], 0)?;
            friction.same("FSTAT", "FKIN")?;
            self.mu = friction.get(0);
        }
        Ok(())
    }

    pub(super) fn read_material(&mut self, reader: &mut Reader<'_>) -> Result<(), InpError> {
        let material = reader.numbers(&["POISS1", "POISS2", "GG1", "GG2"], 0)?;
        material.same("POISS1", "POISS2")?;
        material.same("GG1", "GG2")?;
        (self.poisson, self.shear) = (material.get(0), 1e6 * material.get(2));
        Ok(())
    }

    /// E* of two bodies of the material (Pa).
    pub(super) fn modulus(&self) -> f64 {
        self.shear / (1.0 - self.poisson)
    }

    /// The sections of material and friction of a case file.
    pub(super) fn sections(&self) -> String {
        let young = 2.0 * (1.0 + self.poisson) * self.shear;
        format!(
            "[material]\nyoung = {young:?}\npoisson = {:?}\n\n[friction]\nstatic = {:?}\n",
            self.poisson, self.mu
        )
    }
}
