//! Module 3: two bodies with a quadratic gap.

use super::reader::Reader;
use super::{Common, Digit, InpError, Made, read_solver};
use crate::case::hertz::curvatures_of_axes;

const MM: f64 = 1e-3;
/// Rolled distance over the length of the patch, and over all.
const LENGTHS: f64 = 4.0;

/// What a case may keep from those before it.
#[derive(Debug, Default)]
pub(super) struct Basic {
    common: Common,
    read_before: bool,
    /// Speed (m/s).
    speed: f64,
    /// Spacing (m).
    spacing: f64,
    shape: Option<Shape>,
}

/// What the gap is given by.
#[derive(Clone, Copy, Debug)]
enum Shape {
    /// Coefficients of x^2 and y^2 (1/m).
    Gap([f64; 2]),
    /// Half axes of the patch (m).
    Axes([f64; 2]),
}

impl Basic {
    /// Reads a case, and writes its case file.
    pub(super) fn read(&mut self, reader: &mut Reader<'_>) -> Result<(Digit, Made), InpError> {
        let problem = ["PVTIME", "BOUND", "TANG", "NORM", "FORCE", "STRESS"];
        let [_, bound, tang, norm, force, stress] = reader.digits(problem)?;
        bound.one_of(&[0])?;
        tang.one_of(&[3])?;
        norm.one_of(&[1])?;
        force.one_of(&[0, 1])?;
        stress.one_of(&[0])?;
        let material = ["FRCLAW", "DISCNS", "INFLCF", "MATER", "RZNORM", "EXRHS"];
        let [law, grid, influence, kind, gap, extra] = reader.digits(material)?;
        influence.one_of(&[0, 1, 2])?;
        [kind, extra].iter().try_for_each(|digit| digit.one_of(&[0]))?;
        let back = read_solver(reader, !self.read_before)?;
        self.read_before = true;
        let motion = reader.numbers(&["FN", "CKSI or FX", "CETA", "CPHI"], 2)?;
        let line = motion.line;
        self.common.read_friction(reader, law)?;
        if influence.value >= 2 {
            let rolling = reader.numbers(&["CHI", "DQ", "VELOC"], 0)?;
            rolling.must_be("CHI", 0.0, "bodies roll along x")?;
            self.speed = MM * rolling.get(2);
        }
        self.common.read_material(reader, influence)?;
        let mut notes = Vec::new();
        if grid.value == 2 {
            self.read_grid(reader, gap, &mut notes)?;
        }
        let [load, along, across, spin] = [0, 1, 2, 3].map(|at| motion.get(at));
        let force = (force.value == 1).then_some(along * self.common.mu * load);
        let drive = Drive { load, creepage: -along, force, lateral: across, spin: spin / MM };
        Ok((back, (self.case(line, &drive)?, notes)))
    }

    fn read_grid(
        &mut self,
        reader: &mut Reader<'_>,
        gap: Digit,
        notes: &mut Vec<String>,
    ) -> Result<(), InpError> {
        let kind = reader.numbers(&["IPOTCN"], 0)?;
        let refused = |problem: &str| Err(InpError::new(kind.line, problem));
        let (numbers, hertz) = match kind.get(0) as i64 {
            -1 => (reader.numbers(&["MX", "MY", "A1", "B1", "SCALE"], 0)?, true),
            -3 => (reader.numbers(&["MX", "MY", "AA", "BB", "SCALE"], 0)?, true),
            1 => (reader.numbers(&["MX", "MY", "XL", "YL", "DX", "DY"], 0)?, false),
            3 => (reader.numbers(&["MX", "MY", "XC1", "YC1", "DX", "DY"], 0)?, false),
            _ => return refused("IPOTCN: only -1, -3, 1 and 3 are read"),
        };
        if numbers.get(1) < 2.0 {
            return Err(InpError::new(numbers.line, "MY = 1: line contact is not read"));
        }
        if hertz {
            let pair = [numbers.get(2), numbers.get(3)];
            self.shape = Some(match kind.get(0) as i64 {
                -1 => Shape::Gap(pair.map(|c| c / MM)),
                _ => Shape::Axes(pair.map(|a| a * MM)),
            });
            // the grid of the semi-axes times SCALE
            let points = [numbers.get(0), numbers.get(1)];
            self.spacing = match self.shape {
                Some(Shape::Axes(axes)) => [0, 1]
                    .map(|i| 2.0 * numbers.get(4) * axes[i] / points[i])
                    .into_iter()
                    .fold(f64::INFINITY, f64::min),
                _ => 0.0,
            };
            notes
                .push("MX, MY, SCALE: the grid is square, of the finer of the two spacings".into());
            return Ok(());
        }
        numbers.same("DX", "DY")?;
        self.spacing = MM * numbers.get(4);
        if gap.value == 2 {
            let form = reader.numbers(&["IBASE", "IPLAN"], 0)?;
            form.must_be("IBASE", 1.0, "only a quadratic gap is read")?;
            form.must_be("IPLAN", 1.0, "only an unrestricted planform is read")?;
            let names = &["B1", "B2", "B3", "B4", "B5", "B6"];
            let gap = reader.numbers(names, 0)?;
            for name in ["B2", "B4", "B5", "B6"] {
                gap.must_be(name, 0.0, "the gap must be B1 x^2 + B3 y^2")?;
            }
            self.shape = Some(Shape::Gap([gap.get(0) / MM, gap.get(2) / MM]));
        }
        Ok(())
    }

    fn case(&self, line: usize, drive: &Drive) -> Result<String, InpError> {
        let Common { poisson, shear, .. } = self.common;
        let modulus = shear / (1.0 - poisson);
        let [along, across] = match self.shape {
            Some(Shape::Gap(gap)) => gap,
            Some(Shape::Axes(axes)) => curvatures_of_axes(drive.load, axes, modulus),
            None => return Err(InpError::new(line, "the gap was not given")),
        };
        if !(along > 0.0 && across > 0.0 && self.speed > 0.0 && drive.load > 0.0) {
            return Err(InpError::new(
                line,
                "FN, VELOC and both coefficients of the gap must be above zero",
            ));
        }
        let radius = 0.5 / along;
        // a sphere's patch of the mean curvature
        let patch = libm::cbrt(1.5 * drive.load * radius / modulus);
        let spacing = if self.spacing > 0.0 { self.spacing } else { patch / 20.0 };
        let roll = LENGTHS * 2.0 * patch;
        let motion = match drive.force {
            Some(force) => format!("torque = {:?}", force * radius),
            None => format!("creepage = {:?}", drive.creepage),
        };
        Ok(format!(
            "model = \"half-space\"\nhalf_space.inertia = false\n\n[disk]\nradius = {radius:?}\n\n[bar]\ncrown_radius = {:?}\n\n{}\n\
             [load]\nnormal = {:?}\n\n[drive]\nspeed = {:?}\n{motion}\nlateral_creepage = {:?}\nspin = {:?}\nramp = {:?}\n\n\
             [mesh.zone]\nsize = {spacing:?}\nstart = {:?}\nlength = {:?}\nwidth = {:?}\n\n[time]\nroll = {roll:?}\nfactor = 0.5\n",
            0.5 / across,
            self.common.lines(),
            drive.load,
            self.speed,
            drive.lateral,
            drive.spin,
            0.1 * roll / self.speed,
            -4.0 * patch,
            roll + 8.0 * patch,
            8.0 * patch,
        ))
    }
}

/// What a case prescribes: force (N), creepages, spin (rad/m), and the force along where it stands for a creepage.
struct Drive {
    load: f64,
    creepage: f64,
    force: Option<f64>,
    lateral: f64,
    spin: f64,
}
