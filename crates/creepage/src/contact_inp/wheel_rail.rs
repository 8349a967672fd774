//! Module 1: a wheel on a rail.

use super::reader::{Group, Reader};
use super::{Common, Digit, InpError, Made, read_solver};
use crate::case::profile_at;
use mesh::profile::{Profile, ProfileBody};
use std::path::{Path, PathBuf};

/// Rolled distance of a case (m), and steps in which the patch moves on by a spacing.
const ROLL: f64 = 0.03;
const FACTOR: f64 = 0.5;
const MM: f64 = 1e-3;

/// What a case may keep from those before it.
#[derive(Debug, Default)]
pub(super) struct WheelRail {
    common: Common,
    read_before: bool,
    /// Spacing (m).
    spacing: f64,
    track: Track,
    rail: PathBuf,
    wheel: PathBuf,
    /// Half the distance of the wheels' profiles, at their origins (m), and nominal radius (m).
    half_wheelset: f64,
    radius: f64,
    /// y (m), force (N), roll, yaw (rad).
    position: [f64; 4],
    /// Speed (m/s) and speed of rotation, positive forward (rad/s).
    speed: [f64; 2],
}

#[derive(Debug, Default)]
struct Track {
    /// Depth of the gauge point (m); zero or less: the rail's origin is given.
    depth: f64,
    /// Half the gauge (m), or y of the rail's origin.
    half: f64,
    cant: f64,
}

impl WheelRail {
    /// Reads a case, and writes its case file.
    pub(super) fn read(
        &mut self,
        reader: &mut Reader<'_>,
        folder: &Path,
    ) -> Result<(Digit, Made), InpError> {
        let problem = ["CONFIG", "PVTIME", "BOUND", "TANG", "NORM", "FORCE", "STRESS"];
        let [side, _, bound, tang, norm, force, stress] = reader.digits(problem)?;
        side.one_of(&[0, 1])?;
        bound.one_of(&[0])?;
        tang.one_of(&[3])?;
        norm.one_of(&[1])?;
        [force, stress].iter().try_for_each(|digit| digit.one_of(&[0]))?;
        let material = ["VARFRC", "FRCLAW", "DISCNS", "INFLCF", "MATER", "ZTRACK", "EWHEEL"];
        let [varied, law, grid, influence, kind, track, wheel] = reader.digits(material)?;
        [varied, kind].iter().try_for_each(|digit| digit.one_of(&[0]))?;
        grid.one_of(&[0, 1, 2, 5])?;
        influence.one_of(&[0, 1, 2])?;
        track.one_of(&[0, 1, 2, 3])?;
        wheel.one_of(&[0, 1, 2, 3])?;
        let back = read_solver(reader, !self.read_before)?;
        self.read_before = true;
        self.common.read_friction(reader, law)?;
        self.common.read_material(reader, influence)?;
        let mut notes = Vec::new();
        if grid.value >= 2 {
            self.read_grid(reader, &mut notes)?;
        }
        self.read_track(reader, track, folder)?;
        self.read_wheel(reader, wheel, folder)?;
        let outward = if side.value == 1 { 1.0 } else { -1.0 };
        let text = self.case(outward, reader.line(), &mut notes)?;
        Ok((back, (text, notes)))
    }

    fn read_grid(
        &mut self,
        reader: &mut Reader<'_>,
        notes: &mut Vec<String>,
    ) -> Result<(), InpError> {
        let names = &["DX", "DS", "DQREL", "A_SEP", "D_SEP", "D_COMB"];
        let grid = reader.numbers(names, 2)?;
        grid.same("DX", "DS")?;
        self.spacing = MM * grid.get(0);
        notes.push(
            "DQREL, A_SEP, D_SEP, D_COMB: the program has its own steps, and one plane of contact"
                .into(),
        );
        Ok(())
    }

    fn read_track(
        &mut self,
        reader: &mut Reader<'_>,
        track: Digit,
        folder: &Path,
    ) -> Result<(), InpError> {
        const NONE: &str = "the rail neither moves nor turns";
        if matches!(track.value, 1 | 3) {
            let names = &["GAUGHT", "GAUGSQ", "GAUGWD", "CANT", "CURV"];
            let numbers = reader.numbers(&names[..4], 1)?;
            let depth = MM * numbers.get(0);
            if depth > 0.0 {
                numbers.must_be("GAUGSQ", 0.0, "only the first gauge face is known")?;
            }
            if numbers.get(4) != 0.0 {
                return Err(InpError::new(numbers.line, "CURV: the rail must be straight"));
            }
            let half = if depth > 0.0 { 0.5 * numbers.get(2) } else { numbers.get(1).abs() };
            self.track = Track { depth, half: MM * half, cant: numbers.get(3) };
        }
        if track.value == 3 {
            self.rail = profile(reader, folder)?;
        }
        if matches!(track.value, 2 | 3) {
            let names = &["DYRAIL", "DZRAIL", "DROLLR", "VYRAIL", "VZRAIL", "VROLLR"];
            let numbers = reader.numbers(names, 0)?;
            names.iter().try_for_each(|name| numbers.must_be(name, 0.0, NONE))?;
        }
        Ok(())
    }

    fn read_wheel(
        &mut self,
        reader: &mut Reader<'_>,
        wheel: Digit,
        folder: &Path,
    ) -> Result<(), InpError> {
        if wheel.value == 3 {
            let numbers = reader.numbers(&["FBDIST", "FBPOS", "NOMRADW"], 1)?;
            if numbers.get(3) != 0.0 {
                return Err(InpError::new(
                    numbers.line,
                    "YTAPE: the radius is that at y = 0 of the profile",
                ));
            }
            self.half_wheelset = MM * (0.5 * numbers.get(0) - numbers.get(1));
            self.radius = MM * numbers.get(2);
            self.wheel = profile(reader, folder)?;
        }
        if wheel.value >= 1 {
            // S and PITCH change nothing on a straight rail and a round wheel
            let names = &["S_WS", "Y_WS", "FZ_WS", "ROLL", "YAW", "PITCH"];
            let numbers = reader.numbers(names, 0)?;
            self.position = [MM * numbers.get(1), numbers.get(2), numbers.get(3), numbers.get(4)];
        }
        if wheel.value >= 2 {
            let names = &["VS_WS", "VY_WS", "VZ_WS", "VROLL", "VYAW", "VPITCH"];
            let numbers = reader.numbers(names, 0)?;
            for name in &names[1..5] {
                numbers.must_be(name, 0.0, "only speed and rotation of the wheelset are read")?;
            }
            self.speed = [MM * numbers.get(0), -numbers.get(5)];
        }
        Ok(())
    }

    /// The case file; a right wheel is a left one in a mirror.
    fn case(&self, outward: f64, line: usize, notes: &mut Vec<String>) -> Result<String, InpError> {
        let [lateral, load, roll, yaw] = self.position;
        let [speed, rotation] = self.speed;
        let refused = |problem: String| InpError::new(line, problem);
        if speed <= 0.0 || self.radius <= 0.0 || self.spacing <= 0.0 {
            return Err(refused("VS_WS, NOMRADW and DX must be given, and above zero".into()));
        }
        let rail = profile_at(&self.rail, ProfileBody::Rail).map_err(&refused)?;
        let gauge = if self.track.depth > 0.0 {
            let gauge = gauge_point(&rail, &self.track);
            gauge.ok_or_else(|| {
                refused("GAUGHT: the rail's profile does not reach so deep".into())
            })?
        } else {
            0.0
        };
        let wheel = self.half_wheelset * libm::cos(yaw) * libm::cos(roll) + outward * lateral;
        notes.push(format!(
            "FZ_WS = {load} N, a vertical force, is taken along the normal of the plane of contact: `creepage mesh` tells its angle"
        ));
        if outward > 0.0 {
            notes.push(
                "the right wheel is a left one in a mirror: lateral forces change their sign"
                    .into(),
            );
        }
        let path = |path: &Path| toml::Value::from(path.display().to_string()).to_string();
        Ok(format!(
            "model = \"half-space\"\nhalf_space.inertia = false\n\n[disk]\nradius = {:?}\nprofile = {}\nlateral = {:?}\n\
             yaw = {:?}\nroll = {:?}\n\n[bar]\nprofile = {}\ncant = {:?}\n\n{}\n[load]\nnormal = {load:?}\n\n[drive]\n\
             speed = {speed:?}\ncreepage = {:?}\nramp = {:?}\n\n[mesh.zone]\nsize = {:?}\nwidth = 0.06\n\n[time]\n\
             roll = {ROLL:?}\nfactor = {FACTOR:?}\n",
            self.radius,
            path(&self.wheel),
            wheel - (self.track.half - gauge),
            outward * yaw,
            -outward * roll,
            path(&self.rail),
            self.track.cant,
            self.common.lines(),
            rotation * self.radius / speed - 1.0,
            0.1 * ROLL / speed,
            self.spacing,
        ))
    }
}

/// The path of a profile, which must be taken as it is.
fn profile(reader: &mut Reader<'_>, folder: &Path) -> Result<PathBuf, InpError> {
    let (name, numbers): (String, Group) = reader.name(&["MIRRORY", "SCALEYZ", "SMOOTH"], 2)?;
    numbers.must_be("MIRRORY", 0.0, "a profile is taken as its file has it")?;
    numbers.must_be("SCALEYZ", 1.0, "a profile is taken as its file has it")?;
    numbers.must_be("SMOOTH", 0.0, "profiles are smoothed to 1 um")?;
    for at in [3, 4] {
        if numbers.get(at) != 0.0 {
            return Err(InpError::new(numbers.line, "MIRRORZ and PRFOPT must be 0 or left out"));
        }
    }
    let path = folder.join(name);
    Ok(std::path::absolute(&path).unwrap_or(path))
}

/// y of the gauge point of the leaning rail relative to the origin of its profile (m): on the side of the middle of the track, as
/// deep below the top as the track says.
fn gauge_point(rail: &Profile, track: &Track) -> Option<f64> {
    let (sin, cos) = libm::sincos(track.cant);
    let turned = |u: f64| rail.at(u).map(|[z, ..]| [cos * u + sin * z, cos * z - sin * u]);
    let [low, high] = rail.ends();
    let samples = (0..=4000).map(|i| low + (high - low) * f64::from(i) / 4000.0);
    let highest = samples.filter_map(|u| Some((u, turned(u)?[1])));
    let (mut above, top) = highest.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut below = low;
    if turned(below)?[1] - top < track.depth {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (above + below);
        if turned(middle)?[1] - top > track.depth { below = middle } else { above = middle }
    }
    Some(turned(above)?[0])
}
