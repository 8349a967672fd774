//! Module 3: two bodies with the gap A x^2 + B y^2.

use super::material::Material;
use super::reader::{Digit, InpError, Reader};
use crate::case::hertz::{gap_of_axes, of_gap};

const MM: f64 = 1e-3;
/// Rolled distance over the patch's half axis along.
const ROLL: f64 = 8.0;

/// What a case may keep from those before it.
#[derive(Debug, Default)]
pub(super) struct Basic {
    material: Material,
    /// Speed (m/s).
    speed: f64,
    grid: Option<Grid>,
}

/// What gives the gap and the spacing, as the file has it (mm).
#[derive(Clone, Copy, Debug)]
enum Grid {
    /// Hertz's contact under the force of the case, with IPOTCN, points along and across, A1 and B1, A1 and the ratio of the half
    /// axes, or these, and the size over that of the patch.
    Hertz { kind: f64, points: [f64; 2], shape: [f64; 2], scale: f64 },
    /// Spacing, and the gap's B1 and B3.
    Full { spacing: f64, gap: [f64; 2] },
}

/// What moves the bodies.
struct Motion {
    /// Normal force (N).
    load: f64,
    /// Force along on the upper body (N), where it stands for the creepage.
    force: Option<f64>,
    /// Slip of the upper body on the lower one over the speed.
    slip: [f64; 2],
    /// Spin (rad/m).
    spin: f64,
}

impl Basic {
    /// Reads a case; returns its digit RETURN, and its case file.
    pub(super) fn read(&mut self, reader: &mut Reader<'_>) -> Result<(Digit, String), InpError> {
        let names = ["PVTIME", "BOUND", "TANG", "NORM", "FORCE", "STRESS"];
        let [_, bound, tang, norm, force, stress] = reader.digits(names)?;
        let names = ["VARFRC", "FRCLAW", "DISCNS", "INFLCF", "MATER", "RZNORM", "EXRHS"];
        let [varied, law, grid, influence, kind, gap, extra] = reader.digits(names)?;
        for (digit, allowed) in [
            (bound, &[0][..]),
            (tang, &[3]),
            (norm, &[1]),
            (force, &[0, 1]),
            (stress, &[0]),
            (varied, &[0]),
            (law, &[0, 1]),
            (grid, &[0, 1, 2]),
            (influence, &[0, 1, 2]),
            (kind, &[0]),
            (gap, &[0, 1, 2]),
            (extra, &[0]),
        ] {
            digit.one_of(allowed)?;
        }
        let back = self.material.read_solver(reader)?;
        let numbers = reader.numbers(&["FN", "CKSI or FX", "CETA", "CPHI"], 2)?;
        numbers.must_be_zero_at(4, "SPINXO")?;
        numbers.must_be_zero_at(5, "SPINYO")?;
        self.material.read_friction(reader, law)?;
        if influence.value == 2 {
            let rolling = reader.numbers(&["CHI", "DQ", "VELOC"], 0)?;
            rolling.must_be("CHI", 0.0, "half-spaces roll along x")?;
            self.speed = MM * rolling.get(2);
            self.material.read_material(reader)?;
        }
        let [load, along, across, spin] = [0, 1, 2, 3].map(|at| numbers.get(at));
        if grid.value == 2 {
            self.read_grid(reader)?;
        }
        if let (2, Some(Grid::Full { gap, .. })) = (gap.value, &mut self.grid) {
            *gap = read_gap(reader)?;
        }
        // FX is given over the limit of friction
        let force = (force.value == 1).then_some(along * self.material.mu * load);
        let motion = Motion { load, force, slip: [along, across], spin: spin / MM };
        let text = self.case(&motion);
        Ok((back, text.map_err(|problem| InpError::new(numbers.line, problem))?))
    }

    fn read_grid(&mut self, reader: &mut Reader<'_>) -> Result<(), InpError> {
        let kind = reader.numbers(&["IPOTCN"], 0)?;
        let names: &[_] = match kind.get(0) {
            -3.0 => &["MX", "MY", "AA", "BB", "SCALE"],
            -2.0 => &["MX", "MY", "A1", "AOB", "SCALE"],
            -1.0 => &["MX", "MY", "A1", "B1", "SCALE"],
            1.0 => &["MX", "MY", "XL", "YL", "DX", "DY"],
            3.0 => &["MX", "MY", "XC1", "YC1", "DX", "DY"],
            other => {
                let problem = format!("IPOTCN = {other}: only -3, -2, -1, 1 and 3 are read");
                return Err(InpError::new(kind.line, problem));
            }
        };
        let grid = reader.numbers(names, 0)?;
        let [columns, rows, one, other] = [0, 1, 2, 3].map(|at| grid.get(at));
        if rows < 2.0 {
            return Err(InpError::new(grid.line, "MY = 1: contact along a line is not read"));
        }
        self.grid = Some(if kind.get(0) > 0.0 {
            let gap = match self.grid {
                Some(Grid::Full { gap, .. }) => gap,
                _ => [0.0; 2],
            };
            Grid::Full { spacing: grid.get(4).min(grid.get(5)), gap }
        } else {
            let (points, shape, scale) = ([columns, rows], [one, other], grid.get(4));
            Grid::Hertz { kind: kind.get(0), points, shape, scale }
        });
        Ok(())
    }

    /// A and B of the gap (1/m), and the finer of the two spacings (m), under the force `load` (N).
    fn gap(&self, load: f64) -> ([f64; 2], f64) {
        let modulus = self.material.modulus();
        let (kind, points, [one, other], scale) = match self.grid {
            Some(Grid::Hertz { kind, points, shape, scale }) => (kind, points, shape, scale),
            Some(Grid::Full { spacing, gap }) => return (gap.map(|b| b / MM), MM * spacing),
            None => return ([0.0; 2], 0.0),
        };
        let gap = match kind {
            -3.0 => gap_of_axes(load, [MM * one, MM * other], modulus),
            -2.0 => {
                // the ratio of the axes alone gives that of the coefficients
                let [along, across] = gap_of_axes(load, [other, 1.0], modulus);
                [one / MM, one / MM * across / along]
            }
            _ => [one / MM, other / MM],
        };
        let patch = of_gap(load, gap, modulus);
        (gap, 2.0 * scale * (patch.a / points[0]).min(patch.b / points[1]))
    }

    /// The case file; what is wrong, where there is none.
    fn case(&self, motion: &Motion) -> Result<String, String> {
        let &Motion { load, force, slip, spin } = motion;
        let (gap @ [along, across], spacing) = self.gap(load);
        let patch = of_gap(load, gap, self.material.modulus());
        let given = [load, self.speed, self.material.mu, along, across, spacing, patch.a];
        if !given.iter().all(|x| *x > 0.0) {
            return Err(
                "FN, VELOC, FSTAT, GG, the grid and both curvatures must be above zero".into()
            );
        }
        let (radius, roll) = (0.5 / along, ROLL * patch.a);
        // the upper body drives where it slips back
        let drive = force.map_or(format!("creepage = {:?}", 0.0 - slip[0]), |force| {
            format!("torque = {:?}", force * radius)
        });
        Ok(format!(
            "model = \"half-space\"\nhalf_space.inertia = false\n\n[disk]\nradius = {radius:?}\n\n[bar]\ncrown_radius = {:?}\n\n{}\n\
             [load]\nnormal = {load:?}\n\n[drive]\nspeed = {:?}\n{drive}\nlateral_creepage = {:?}\nspin = {spin:?}\nramp = {:?}\n\n\
             [mesh.zone]\nsize = {:?}\nstart = {:?}\nlength = {:?}\nwidth = {:?}\n\n[time]\nroll = {roll:?}\nfactor = 0.5\n",
            0.5 / across,
            self.material.sections(),
            self.speed,
            slip[1],
            0.1 * roll / self.speed,
            spacing,
            -2.0 * patch.a,
            roll + 4.0 * patch.a,
            4.0 * patch.b,
        ))
    }
}

/// B1 and B3 (1/mm) of the gap, which must have no other part.
fn read_gap(reader: &mut Reader<'_>) -> Result<[f64; 2], InpError> {
    let form = reader.numbers(&["IBASE", "IPLAN"], 0)?;
    form.must_be("IBASE", 1.0, "only a quadratic gap is read")?;
    form.must_be("IPLAN", 1.0, "half-spaces touch wherever the gap closes")?;
    let gap = reader.numbers(&["B1", "B2", "B3", "B4", "B5", "B6"], 0)?;
    for name in ["B2", "B4", "B5", "B6"] {
        gap.must_be(name, 0.0, "the gap must be B1 x^2 + B3 y^2")?;
    }
    Ok([gap.get(0), gap.get(2)])
}
