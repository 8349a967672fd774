//! Module 1: a wheel on a rail.

use super::material::Material;
use super::reader::{Digit, InpError, Reader};
use crate::case::profile_at;
use mesh::profile::{Profile, ProfileBody};
use std::path::{Path, PathBuf};

/// Rolled distance of a case (m).
const ROLL: f64 = 0.03;
const MM: f64 = 1e-3;

/// What a case may keep from those before it.
#[derive(Debug, Default)]
pub(super) struct WheelRail {
    folder: PathBuf,
    material: Material,
    /// Spacing (m).
    spacing: f64,
    /// Depth of the gauge point, half the gauge (m), and lean of the rail (rad).
    track: [f64; 3],
    rail: PathBuf,
    wheel: PathBuf,
    /// Half the distance of the wheels' profiles, at their origins, and nominal radius (m).
    wheelset: [f64; 2],
    /// y (m), force (N), roll, yaw (rad).
    position: [f64; 4],
    /// Speed (m/s) and speed of rotation, positive forward (rad/s).
    speed: [f64; 2],
}

impl WheelRail {
    pub(super) fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), ..Self::default() }
    }

    /// Reads a case; returns its digit RETURN, and its case file.
    pub(super) fn read(&mut self, reader: &mut Reader<'_>) -> Result<(Digit, String), InpError> {
        let names = ["CONFIG", "PVTIME", "BOUND", "TANG", "NORM", "FORCE", "STRESS"];
        let [side, _, bound, tang, norm, force, stress] = reader.digits(names)?;
        let names = ["VARFRC", "FRCLAW", "DISCNS", "INFLCF", "MATER", "ZTRACK", "EWHEEL"];
        let [varied, law, grid, influence, kind, track, wheel] = reader.digits(names)?;
        for (digit, allowed) in [
            (side, &[0, 1][..]),
            (bound, &[0]),
            (tang, &[3]),
            (norm, &[1]),
            (force, &[0]),
            (stress, &[0]),
            (varied, &[0]),
            (law, &[0, 1]),
            (grid, &[0, 1, 2, 5]),
            (influence, &[0, 1, 2]),
            (kind, &[0]),
            (track, &[0, 1, 2, 3]),
            (wheel, &[0, 1, 2, 3]),
        ] {
            digit.one_of(allowed)?;
        }
        let back = self.material.read_solver(reader)?;
        self.material.read_friction(reader, law)?;
        if influence.value == 2 {
            self.material.read_material(reader)?;
        }
        if grid.value >= 2 {
            let grid = reader.numbers(&["DX", "DS", "DQREL", "A_SEP", "D_SEP", "D_COMB"], 2)?;
            grid.same("DX", "DS")?;
            self.spacing = MM * grid.get(0);
        }
        self.read_track(reader, track)?;
        self.read_wheel(reader, wheel)?;
        let outward = if side.value == 1 { 1.0 } else { -1.0 };
        let text = self.case(outward);
        Ok((back, text.map_err(|problem| InpError::new(reader.line(), problem))?))
    }

    fn read_track(&mut self, reader: &mut Reader<'_>, track: Digit) -> Result<(), InpError> {
        if matches!(track.value, 1 | 3) {
            let names = &["GAUGHT", "GAUGSQ", "GAUGWD", "CANT"];
            let numbers = reader.numbers(names, 1)?;
            numbers.must_be("GAUGSQ", 0.0, "the gauge is measured at the first face")?;
            numbers.must_be_zero_at(4, "CURV")?;
            self.track = [MM * numbers.get(0), 0.5 * MM * numbers.get(2), numbers.get(3)];
        }
        if track.value == 3 {
            self.rail = self.profile(reader)?;
        }
        if track.value >= 2 {
            let names = &["DYRAIL", "DZRAIL", "DROLLR", "VYRAIL", "VZRAIL", "VROLLR"];
            let numbers = reader.numbers(names, 0)?;
            names.iter().try_for_each(|name| numbers.must_be(name, 0.0, "the rail stays"))?;
        }
        Ok(())
    }

    fn read_wheel(&mut self, reader: &mut Reader<'_>, wheel: Digit) -> Result<(), InpError> {
        if wheel.value == 3 {
            let numbers = reader.numbers(&["FBDIST", "FBPOS", "NOMRADW"], 1)?;
            numbers.must_be_zero_at(3, "YTAPE")?;
            let half = 0.5 * numbers.get(0) - numbers.get(1);
            self.wheelset = [MM * half, MM * numbers.get(2)];
            self.wheel = self.profile(reader)?;
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
            let why = "only speed and rotation of the wheelset are read";
            names[1..5].iter().try_for_each(|name| numbers.must_be(name, 0.0, why))?;
            self.speed = [MM * numbers.get(0), -numbers.get(5)];
        }
        Ok(())
    }

    /// The path of a profile, which must be taken as it is.
    fn profile(&self, reader: &mut Reader<'_>) -> Result<PathBuf, InpError> {
        const AS_IT_IS: &str = "a profile is taken as its file has it, smoothed to 1 um";
        let (name, numbers) = reader.name(&["MIRRORY", "SCALEYZ", "SMOOTH"], 2)?;
        for (name, value) in [("MIRRORY", 0.0), ("SCALEYZ", 1.0), ("SMOOTH", 0.0)] {
            numbers.must_be(name, value, AS_IT_IS)?;
        }
        numbers.must_be_zero_at(3, "MIRRORZ")?;
        numbers.must_be_zero_at(4, "PRFOPT")?;
        let path = self.folder.join(name);
        Ok(std::path::absolute(&path).unwrap_or(path))
    }

    /// The case file; a right wheel is a left one in a mirror. What is wrong, where there is none.
    fn case(&self, outward: f64) -> Result<String, String> {
        let ([lateral, load, roll, yaw], [speed, rotation]) = (self.position, self.speed);
        let ([half_wheelset, radius], [depth, half_gauge, cant]) = (self.wheelset, self.track);
        if [speed, radius, self.spacing, depth].iter().any(|x| *x <= 0.0) {
            return Err("VS_WS, NOMRADW, DX and GAUGHT must be above zero".into());
        }
        let rail = profile_at(&self.rail, ProfileBody::Rail)?;
        let gauge = gauge_point(&rail, depth, cant)
            .ok_or("GAUGHT: the rail's profile does not reach so deep")?;
        let wheel = half_wheelset * libm::cos(yaw) * libm::cos(roll) + outward * lateral;
        let path = |path: &Path| toml::Value::from(path.display().to_string());
        let [wheel_file, rail_file] = [path(&self.wheel), path(&self.rail)];
        Ok(format!(
            "model = \"half-space\"\nhalf_space.inertia = false\n\n[disk]\nradius = {radius:?}\nprofile = {wheel_file}\n\
             lateral = {:?}\nyaw = {:?}\nroll = {:?}\n\n[bar]\nprofile = {rail_file}\ncant = {cant:?}\n\n{}\n\
             # a vertical force in CONTACT; here along the \
             normal of the plane of contact\n[load]\nnormal = {load:?}\n\n[drive]\nspeed = {speed:?}\ncreepage = {:?}\n\
             ramp = {:?}\n\n[mesh.zone]\nsize = {:?}\nwidth = 0.06\n\n[time]\nroll = {ROLL:?}\nfactor = 0.5\n",
            wheel - (half_gauge - gauge),
            outward * yaw,
            -outward * roll,
            self.material.sections(),
            rotation * radius / speed - 1.0,
            0.1 * ROLL / speed,
            self.spacing,
        ))
    }
}

/// y of the gauge point of the leaning rail relative to the origin of its profile (m): on the side of the middle of the track,
/// `depth` (m) below the top.
fn gauge_point(rail: &Profile, depth: f64, cant: f64) -> Option<f64> {
    let (sin, cos) = libm::sincos(cant);
    let turned = |u: f64| rail.at(u).map(|[z, ..]| [cos * u + sin * z, cos * z - sin * u]);
    let [low, high] = rail.ends();
    let samples = (0..=4000).map(|i| low + (high - low) * f64::from(i) / 4000.0);
    let heights = samples.filter_map(|u| Some((u, turned(u)?[1])));
    let (mut above, top) = heights.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut below = low;
    for _ in 0..60 {
        let middle = 0.5 * (above + below);
        if turned(middle)?[1] - top > depth { below = middle } else { above = middle }
    }
    (turned(low)?[1] - top >= depth).then_some(turned(above)?[0])
}
