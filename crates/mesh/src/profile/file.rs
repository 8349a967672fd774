//! Profile files: SIMPACK's `.prr` and `.prw`, or two columns.

use super::ProfileError;

/// Whose profile is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProfileBody {
    /// Of a rail.
    Rail,
    /// Of a wheel.
    Wheel,
}

impl ProfileBody {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Rail => "rail",
            Self::Wheel => "wheel",
        }
    }
}

/// Fewest points of a profile, and its least width (m).
const FEWEST: usize = 8;
const NARROWEST: f64 = 10e-3;
/// Numbers over less than this (in the file's unit, mm) are those of metres.
const METRES: f64 = 0.5;
/// A polygon of points that turns by more than this (degrees) has a kink. Points 2 mm apart turn by 9 degrees on an arc of
/// 13 mm.
const KINK: f64 = 20.0;

/// What the header of a SIMPACK file says of its points.
struct Header {
    /// One of the file's unit of length (m), if the file says it.
    unit: Option<f64>,
    /// Whether the lines are those between `header.begin` and `header.end`.
    first: bool,
    /// Signs of y and z.
    signs: [f64; 2],
    shift: [f64; 2],
}

/// The points (y, z) of a profile file (m), y rising: the points of a SIMPACK file (between `point.begin` and `point.end`), or
/// two columns in mm, y away from the middle of the track and z down, apart by blanks, commas or semicolons; `!`, `#` and `%`
/// begin comments.
///
/// # Errors
/// [`ProfileError`], with the line or the place.
pub fn read_profile(text: &str, body: ProfileBody) -> Result<Vec<[f64; 2]>, ProfileError> {
    let simpack = text.lines().any(|line| line.trim_start().starts_with("point.begin"));
    let mut header = Header { unit: None, first: false, signs: [1.0; 2], shift: [0.0; 2] };
    let (mut points, mut in_points) = (Vec::new(), !simpack);
    for (line, text) in (1..).zip(text.lines()) {
        let content = text.split(['!', '#', '%']).next().unwrap_or_default().trim();
        match content {
            "" => {}
            "point.begin" => in_points = true,
            "point.end" => in_points = false,
            _ if in_points => points.push(point(line, content)?),
            _ => header.read(line, content, body)?,
        }
    }
    let mut points: Vec<[f64; 2]> = points.iter().map(|p| header.in_metres(*p)).collect();
    // files list points in either direction
    if points.first().zip(points.last()).is_some_and(|(first, last)| last[0] < first[0]) {
        points.reverse();
    }
    check(&points, header.unit.is_some())?;
    Ok(points)
}

impl Header {
    /// Takes `key = value` over; refuses what would change the points in another way.
    fn read(&mut self, line: usize, content: &str, body: ProfileBody) -> Result<(), ProfileError> {
        let Some((key, value)) = content.split_once('=') else {
            self.first = content == "header.begin" || (self.first && content != "header.end");
            return Ok(());
        };
        let (key, value) = (key.trim(), value.trim());
        let Ok(number) = value.parse::<f64>() else { return Ok(()) };
        match key {
            // elsewhere it is that of the original data
            "type" if self.first => {
                let found = if number == 0.0 { ProfileBody::Rail } else { ProfileBody::Wheel };
                if found != body {
                    return Err(ProfileError::Body { found, wanted: body });
                }
            }
            "units.len.f" if number > 0.0 => self.unit = Some(1.0 / number),
            "mirror.y" if number == 1.0 => self.signs[0] = -1.0,
            "mirror.z" if number == 1.0 => self.signs[1] = -1.0,
            "shift.y" => self.shift[0] = number,
            "shift.z" => self.shift[1] = number,
            "rotate" | "approx.smooth" | "point.dist.min" if number != 0.0 => {
                let problem = format!("{key} = {value} is not read");
                return Err(ProfileError::Line { line, problem });
            }
            _ => {}
        }
        Ok(())
    }

    fn in_metres(&self, point: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| self.unit.unwrap_or(1e-3) * self.signs[i] * (point[i] + self.shift[i]))
    }
}

fn point(line: usize, content: &str) -> Result<[f64; 2], ProfileError> {
    let refused = |problem: String| ProfileError::Line { line, problem };
    let mut columns = content.split([' ', '\t', ',', ';']).filter(|word| !word.is_empty());
    let mut number = || {
        let word = columns.next().unwrap_or_default();
        let value = word.parse().ok().filter(|x: &f64| x.is_finite());
        value.ok_or_else(|| refused(format!("'{content}' must be y and z in millimetres")))
    };
    Ok([number()?, number()?])
}

/// Whether points are those of a profile; a file that does not say its unit may be one in metres.
pub(super) fn check(points: &[[f64; 2]], says_unit: bool) -> Result<(), ProfileError> {
    let mm = |x: f64| 1e3 * x;
    let width = points.first().zip(points.last()).map_or(0.0, |(first, last)| last[0] - first[0]);
    if !says_unit && points.len() >= FEWEST && mm(width) < METRES && width > 0.0 {
        return Err(ProfileError::Metres { width: mm(width) });
    }
    if points.len() < FEWEST || width < NARROWEST {
        return Err(ProfileError::Short { points: points.len(), width_mm: mm(width) });
    }
    for (i, pair) in points.windows(2).enumerate() {
        let [before, here] = [pair[0][0], pair[1][0]];
        if here <= before {
            let (before_mm, y_mm) = (mm(before), mm(here));
            return Err(ProfileError::Undercut { point: i + 2, before_mm, y_mm });
        }
    }
    for (i, three) in points.windows(3).enumerate() {
        let direction = |a: [f64; 2], b: [f64; 2]| libm::atan2(b[1] - a[1], b[0] - a[0]);
        let turn = direction(three[1], three[2]) - direction(three[0], three[1]);
        let degrees = turn.abs().to_degrees();
        if degrees > KINK {
            return Err(ProfileError::Kink { point: i + 2, y_mm: mm(three[1][0]), degrees });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write as _;

    /// A crown of 300 mm, in mm, changed by `change`.
    fn crown(change: impl Fn(usize, [f64; 2]) -> [f64; 2]) -> String {
        let mut text = "% a crown\n".to_owned();
        for i in 0..61 {
            let y = i as f64 - 30.0;
            let [y, z] = change(i, [y, 300.0 - (90_000.0 - y * y).sqrt()]);
            writeln!(text, "{y}, {z} ! point {i}").unwrap();
        }
        text
    }

    fn refused(text: &str) -> String {
        read_profile(text, ProfileBody::Rail).unwrap_err().to_string()
    }

    #[test]
    fn two_columns_are_read_in_either_order() {
        let read = |text: &str| read_profile(text, ProfileBody::Rail).unwrap();
        let up = read(&crown(|_, p| p));
        assert_eq!((up.len(), up[0][0], up[30]), (61, -0.03, [0.0, 0.0]));
        assert_eq!(read(&crown(|_, [y, z]| [-y, z])), up);
    }

    #[test]
    fn bad_profiles_are_refused_with_the_place() {
        assert!(refused(&crown(|_, p| p.map(|x| 1e-3 * x))).contains("look like metres"));
        let short: String = crown(|_, p| p).lines().take(6).map(|l| format!("{l}\n")).collect();
        assert!(refused(&short).contains("too short: 5 points over 4.000 mm"));
        let undercut = crown(|i, [y, z]| [if i == 50 { 18.5 } else { y }, z]);
        assert!(refused(&undercut).contains("undercut"), "{}", refused(&undercut));
        let kinked = crown(|i, [y, z]| [y, z + if i > 40 { 0.5 * (y - 10.0) } else { 0.0 }]);
        assert!(refused(&kinked).contains("degrees at y = 10.0000 mm, point 41"));
        assert!(refused("1 2\n3 x\n").contains("line 2"), "{}", refused("1 2\n3 x\n"));
        assert!(refused("").contains("too short"));
    }

    #[test]
    fn a_simpack_file_says_its_unit_its_mirror_and_its_body() {
        let text = |body: u8, rotate: f64| {
            let points = crown(|_, [y, z]| [1e-3 * y, 1e-3 * z]);
            format!(
                "header.begin\n type = {body} ! 0 rail\nheader.end\nspline.begin\n mirror.y = 1\n \
                 rotate = {rotate}\n! units.len = 'm'\n units.len.f = 1.0\n point.begin\n{points}\n point.end\nspline.end\n"
            )
        };
        let points = read_profile(&text(0, 0.0), ProfileBody::Rail).unwrap();
        assert!((points[0][0] + 0.03).abs() < 1e-15 && points.len() == 61);
        assert!(refused(&text(1, 0.0)).contains("profile of a wheel, and that of a rail is meant"));
        assert!(refused(&text(0, 0.1)).contains("line 6: rotate = 0.1"));
    }
}
