//! The table of keys: what each may hold, its unit, and what to do where it does not.

use std::fmt;

/// One end of a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// The value itself is allowed.
    Closed(f64),
    /// The value itself is not allowed.
    Open(f64),
}

/// A range of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end.
    pub low: End,
    /// Upper end.
    pub high: End,
}

impl Range {
    /// Whether `x` lies in the range; NaN lies in none.
    pub fn holds(&self, x: f64) -> bool {
        let low = match self.low {
            End::Closed(end) => x >= end,
            End::Open(end) => x > end,
        };
        let high = match self.high {
            End::Closed(end) => x <= end,
            End::Open(end) => x < end,
        };
        low && high
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.low {
            End::Closed(end) => write!(f, "at least {}", number(end))?,
            End::Open(end) => write!(f, "greater than {}", number(end))?,
        }
        match self.high {
            End::Closed(end) => write!(f, " and at most {}", number(end)),
            End::Open(end) => write!(f, " and less than {}", number(end)),
        }
    }
}

/// A number as a person would write it.
pub fn number(x: f64) -> String {
    let size = x.abs();
    if size != 0.0 && !(1e-3..1e6).contains(&size) { format!("{x:e}") } else { format!("{x}") }
}

/// What kind of value a key holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A number in a range.
    Number(Range),
    /// A whole number from the first to the second.
    Count(u64, u64),
    /// `true` or `false`.
    Flag,
    /// One of these words.
    Word(&'static [&'static str]),
    /// Any text.
    Text,
    /// `"flat"` or a radius in the range.
    Crown(Range),
    /// A penalty stiffness in one of its three forms.
    Stiffness,
    /// A list of pairs of numbers.
    Points,
    /// A curve: pairs of numbers at least 0, the first of them rising from 0. In a file it may be the
    /// path of another file.
    Curve,
}

/// One key of a case file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Dotted path; `[]` stands for the index in an array of tables.
    pub path: &'static str,
    /// What it holds.
    pub form: Form,
    /// SI unit; `-` for dimensionless, empty where the value is no number.
    pub unit: &'static str,
    /// Whether a case must give it.
    pub needed: bool,
    /// What to do where the value is refused, or the key is missing.
    pub remedy: &'static str,
}

/// Ranges of the three forms of a penalty stiffness: factor (-), areal (N/m^3), stability (-).
pub const STIFFNESS: [(&str, Range, &str); 3] = [
    ("", over(0.0, 100.0), "-"),
    ("stiffness", over(0.0, 1e18), "N/m^3"),
    ("stability", over(0.0, 2.0), "-"),
];

const fn over(low: f64, high: f64) -> Range {
    Range { low: End::Open(low), high: End::Closed(high) }
}

const fn within(low: f64, high: f64) -> Range {
    Range { low: End::Closed(low), high: End::Closed(high) }
}

const fn below(low: f64, high: f64) -> Range {
    Range { low: End::Closed(low), high: End::Open(high) }
}

const fn key(path: &'static str, form: Form, unit: &'static str, remedy: &'static str) -> Key {
    Key { path, form, unit, needed: false, remedy }
}

const fn needed(path: &'static str, form: Form, unit: &'static str, remedy: &'static str) -> Key {
    Key { path, form, unit, needed: true, remedy }
}

use Form::{Count, Crown, Flag, Number, Points, Stiffness, Text, Word};

const LENGTH: Form = Number(over(0.0, 10.0));
const PLACE: Form = Number(within(-10.0, 10.0));
const YOUNG: Form = Number(within(1e3, 1e13));
const POISSON: Form = Number(below(0.0, 0.5));
const DENSITY: Form = Number(within(1.0, 1e5));

const METRES: &str = "give the length in metres: 0.06 for 60 mm";
const SET: &str = "give the name of a set of the mesh file in quotes";
const YOUNG_REMEDY: &str = "give Young's modulus in pascal: 210e9 for steel";
const POISSON_REMEDY: &str =
    "an explicit solid needs a finite wave speed: steel has 0.3, rubber-like bodies up to 0.49";
const DENSITY_REMEDY: &str = "give the density in kg/m^3: 7800 for steel";
const INTERVAL: &str = "give a positive time in seconds: 5.7e-6 for 5.7 microseconds";

/// Every key of a case file, in the order of the schema.
pub const KEYS: &[Key] = &[
    key("name", Text, "", "use letters, digits, '-', '_' and '.', as in a folder's name"),
    key("title", Text, "", "give one line of text in quotes"),
    key("extends", Text, "", "give the path of another case file, relative to this one"),
    key("deterministic", Flag, "", "give true or false"),
    key("disk.radius", LENGTH, "m", METRES),
    key("disk.hub_radius", LENGTH, "m", METRES),
    key("disk.width", LENGTH, "m", METRES),
    key("disk.crown_radius", Crown(over(0.0, 1e4)), "m", "give the radius in metres, or \"flat\""),
    key(
        "disk.lift",
        Number(within(0.0, 0.1)),
        "m",
        "leave it out: the disk then touches the bar at the start",
    ),
    key("disk.material.young", YOUNG, "Pa", YOUNG_REMEDY),
    key("disk.material.poisson", POISSON, "-", POISSON_REMEDY),
    key("disk.material.density", DENSITY, "kg/m^3", DENSITY_REMEDY),
    key("bar.length", LENGTH, "m", METRES),
    key("bar.width", LENGTH, "m", METRES),
    key("bar.height", LENGTH, "m", METRES),
    key("bar.crown_radius", Crown(over(0.0, 1e4)), "m", "give the radius in metres, or \"flat\""),
    key("bar.start", PLACE, "m", "give x of the bar's rear end, negative: rolling starts at x = 0"),
    key("bar.ends", Word(&["quiet", "free"]), "", "choose one of the words"),
    key("bar.material.young", YOUNG, "Pa", YOUNG_REMEDY),
    key("bar.material.poisson", POISSON, "-", POISSON_REMEDY),
    key("bar.material.density", DENSITY, "kg/m^3", DENSITY_REMEDY),
    key("material.young", YOUNG, "Pa", YOUNG_REMEDY),
    key("material.poisson", POISSON, "-", POISSON_REMEDY),
    key("material.density", DENSITY, "kg/m^3", DENSITY_REMEDY),
    key(
        "mesh.file",
        Text,
        "",
        "give the path of a .msh, .inp or .vtu file in quotes, relative to the case file; with --set, \
         to the working directory",
    ),
    key("mesh.sha256", Text, "", "leave it out: it is written into the case of a run"),
    key("mesh.unit", Word(&["m", "cm", "mm", "in"]), "", "choose one of the words"),
    key("mesh.sets.disk", Text, "", SET),
    key("mesh.sets.bar", Text, "", SET),
    key("mesh.sets.hub", Text, "", SET),
    key("mesh.sets.tread", Text, "", SET),
    key("mesh.sets.top", Text, "", SET),
    key("mesh.sets.clamp", Text, "", SET),
    key(
        "mesh.growth",
        Number(within(1.05, 3.0)),
        "-",
        "give the ratio of neighbouring element sizes: 1.35 grades gently",
    ),
    key("mesh.coarsest", LENGTH, "m", METRES),
    key("mesh.plane_strain", Flag, "", "give true or false, without quotes"),
    key(
        "mesh.zone.size",
        Number(over(0.0, 0.1)),
        "m",
        "give the element size in metres: 1e-3 for 1 mm",
    ),
    key("mesh.zone.length", LENGTH, "m", METRES),
    key("mesh.zone.width", LENGTH, "m", METRES),
    key("mesh.zone.depth", LENGTH, "m", METRES),
    key(
        "mesh.zone.start",
        PLACE,
        "m",
        "give x of the zone's rear end, negative: rolling starts at x = 0",
    ),
    key(
        "element.hourglass",
        Number(within(0.0, 1.0)),
        "-",
        "0.05 is usual; 0.01 to 0.1 is the sensible range",
    ),
    key("element.contact_layers", Word(&["one-point", "full"]), "", "choose one of the words"),
    key("element.layers", Count(1, 1000), "layers", "give a whole number: 2"),
    key("element.volumetric", Word(&["mean", "full"]), "", "choose one of the words"),
    needed(
        "load.normal",
        Number(over(0.0, 1e8)),
        "N",
        "give the force that presses the disk down, positive, in newtons: `normal = 100e3`; a \
         load upwards would lift the disk off the bar",
    ),
    key("load.mode", Word(&["load", "height"]), "", "choose one of the words"),
    key("load.hub_mass", Number(within(0.0, 1e5)), "kg", "give a mass in kg; 0 for the disk alone"),
    needed(
        "drive.speed",
        Number(over(0.0, 500.0)),
        "m/s",
        "give the rolling speed in +x in m/s: `speed = 38.89`",
    ),
    key("drive.mode", Word(&["creepage", "torque"]), "", "choose one of the words"),
    key(
        "drive.creepage",
        Number(within(-0.5, 0.5)),
        "-",
        "give a plain ratio, not per cent or per mille: 2.4e-3 for 2.4 per mille",
    ),
    key("drive.torque", Number(within(-1e7, 1e7)), "N m", "give the torque in N m"),
    key("drive.ramp", Number(within(0.0, 1.0)), "s", "give a time in seconds: 0.74e-3"),
    key(
        "friction.law",
        Word(&[
            "coulomb",
            "exponential",
            "slip_weakening",
            "rate_state",
            "prakash_clifton",
            "table",
            "expression",
            "python",
        ]),
        "",
        "choose one of the words",
    ),
    needed(
        "friction.static",
        Number(within(0.0, 5.0)),
        "-",
        "give the coefficient of friction: `static = 0.5`",
    ),
    key("friction.dynamic", Number(within(0.0, 5.0)), "-", "give a coefficient of friction: 0.32"),
    key("friction.decay", Number(within(0.0, 1e4)), "s/m", "give the decay in s/m: 6.0"),
    key(
        "friction.distance",
        Number(over(0.0, 10.0)),
        "m",
        "give the slip over which friction changes, in metres: `distance = 10e-6`",
    ),
    key(
        "friction.relaxation_speed",
        Number(over(0.0, 1e3)),
        "m/s",
        "give V* of the law in m/s: 1.0",
    ),
    key("friction.reference", Number(over(0.0, 5.0)), "-", "give a coefficient of friction: 0.6"),
    key("friction.reference_speed", Number(over(0.0, 100.0)), "m/s", "give V_0 in m/s: 1e-6"),
    key("friction.direct", Number(within(1e-4, 1.0)), "-", "give the direct effect a: 0.008"),
    key("friction.evolution", Number(within(0.0, 1.0)), "-", "give the effect b: 0.012"),
    key("friction.state", Word(&["ageing", "slip"]), "", "choose one of the words"),
    key("friction.age", Number(over(0.0, 1e12)), "s", "give the state theta in seconds: 10"),
    key(
        "friction.table",
        Form::Curve,
        "",
        "give the path of a CSV file, relative to this one, or pairs of slip velocity (m/s), rising from 0, \
         and coefficient: `table = [[0, 0.5], [1, 0.32]]`",
    ),
    key(
        "friction.expression",
        Text,
        "",
        "give a formula in s, p, t and x in quotes: `expression = \"0.32 + 0.18*exp(-6*s)\"`",
    ),
    key("friction.source", Text, "", "give the source of the function in quotes"),
    key("friction.mode", Word(&["lagged", "exact"]), "", "choose one of the words"),
    key(
        "friction.memory.distance",
        Number(over(0.0, 1.0)),
        "m",
        "give the slip over which friction adapts, in metres: 10e-6 for 10 micrometres",
    ),
    key(
        "friction.memory.floor",
        Number(over(0.0, 100.0)),
        "m/s",
        "give the slip speed below which friction adapts in time: 10e-3",
    ),
    key("contact.enforcement", Word(&["penalty", "exact"]), "", "choose one of the words"),
    key("contact.rows", Word(&["node_to_face", "mortar"]), "", "choose one of the words"),
    key("contact.curvature", Flag, "", "give true or false, without quotes"),
    key("contact.penalty.normal", Stiffness, "-", STIFFNESS_REMEDY),
    key("contact.penalty.tangential", Stiffness, "-", STIFFNESS_REMEDY),
    key(
        "contact.penalty.damping",
        Number(within(0.0, 1.0)),
        "-",
        "give a fraction of critical, not per cent: 0.1",
    ),
    key("damping.bulk_linear", Number(within(0.0, 2.0)), "-", "0.06 is usual; 0 turns it off"),
    key("damping.bulk_quadratic", Number(within(0.0, 20.0)), "-", "1.2 is usual; 0 turns it off"),
    key(
        "damping.kelvin_voigt",
        Number(within(0.0, 1e-3)),
        "s",
        "give 0.1 to 1 time steps, about 1e-8 s; 0 turns it off",
    ),
    key("damping.mass", Number(within(0.0, 1e6)), "1/s", "give a rate in 1/s; 0 turns it off"),
    key("preload.method", Word(&["static", "relaxation", "none"]), "", "choose one of the words"),
    key(
        "preload.tolerance",
        Number(over(0.0, 1e-2)),
        "-",
        "give the residual over the load (static) or the ratio of kinetic to internal energy: 1e-9",
    ),
    key(
        "preload.max_iterations",
        Count(1, 100_000_000),
        "-",
        "give a whole number: 100 (static), 40000 (relaxation)",
    ),
    key("preload.disturbance", Number(over(0.0, 1e-3)), "-", "give a small part, such as 1e-9"),
    key("preload.seed", Count(0, 1_000_000), "-", "give a whole number"),
    key(
        "time.factor",
        Number(over(0.0, 2.0)),
        "-",
        "0.67 is the default; up to 1 is stable, up to 2 is accepted to show a blow-up",
    ),
    key("time.step", Number(over(0.0, 1e-3)), "s", "give the step in seconds: 1.5e-7"),
    key("time.roll", LENGTH, "m", "give the rolled distance in metres: 0.06"),
    key("time.duration", Number(over(0.0, 10.0)), "s", "give the time in seconds: 1.5e-3"),
    key("evaluate.last", LENGTH, "m", "give the rolled distance in metres: 0.02"),
    key("evaluate.transits", Number(over(0.0, 1e4)), "-", "give contact transits 2a: 4"),
    key("output.fields_interval", Number(over(0.0, 10.0)), "s", INTERVAL),
    key("output.stress", Flag, "", "give true or false, without quotes"),
    key("output.contact_interval", Number(over(0.0, 10.0)), "s", INTERVAL),
    key("output.history_interval", Count(1, 1_000_000), "steps", "give a whole number: 10"),
    key("output.probes.bar", Points, "m", "give pairs: [[0.02, 0.0], [0.03, 0.0]]"),
    key("output.probes.disk", Points, "m", "give pairs: [[0.02, 0.0], [0.03, 0.0]]"),
    needed("output.window[].from", Number(within(0.0, 10.0)), "s", "give the start in seconds"),
    needed("output.window[].to", Number(over(0.0, 10.0)), "s", "give the end in seconds"),
    key("output.window[].every", Count(1, 1_000_000), "steps", "give a whole number: 1"),
    key("checkpoint.steps", Count(1, 1_000_000_000), "steps", "give a whole number: 100000"),
    key("checkpoint.time", Number(over(0.0, 10.0)), "s", INTERVAL),
    key("checkpoint.wall_minutes", Number(within(0.0, 1e5)), "min", "give minutes, 0 for none: 5"),
    key("guards.hourglass", Number(over(0.0, 1e6)), "-", "give a share of the strain energy: 0.5"),
    key(
        "guards.penetration",
        Number(over(0.0, 1e6)),
        "-",
        "give element sizes: 0.5 for half a one",
    ),
    key("guards.parted", Number(over(0.0, 10.0)), "s", "give a time in seconds: 1e-4"),
    key("guards.friction", Number(over(0.0, 1e12)), "-", "give a coefficient of friction: 5"),
];

const STIFFNESS_REMEDY: &str = "give a scale factor (0.1), an areal stiffness \
     ({ stiffness = 3.5e13 }) or a fraction of the stability limit ({ stability = 0.5 })";

/// The row of a key by its path, indices written as `[]`.
pub fn find(path: &str) -> Option<&'static Key> {
    KEYS.iter().find(|key| key.path == path)
}

/// Whether every dotted path in a text is that of a key or a section, and every word in square brackets
/// that of a section. To be asked while compiling.
pub(crate) const fn names_only_keys(text: &str) -> bool {
    let text = text.as_bytes();
    let mut at = 0;
    while at < text.len() {
        let start = at;
        let mut dots = 0;
        while at < text.len() && (is_of_path(text[at]) || dotted(text, at)) {
            dots += (text[at] == b'.') as usize;
            at += 1;
        }
        let in_brackets =
            start > 0 && text[start - 1] == b'[' && at < text.len() && text[at] == b']';
        let begins = at > start && text[start].is_ascii_lowercase();
        if begins && (dots > 0 || in_brackets) && !is_there(text, start, at) {
            return false;
        }
        at += 1;
    }
    true
}

const fn is_of_path(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Whether there is a dot with a letter on both its sides.
const fn dotted(text: &[u8], at: usize) -> bool {
    text[at] == b'.'
        && at > 0
        && is_of_path(text[at - 1])
        && at + 1 < text.len()
        && text[at + 1].is_ascii_alphabetic()
}

/// Whether the bytes from `start` to `end` are the path of a key or of a section.
const fn is_there(text: &[u8], start: usize, end: usize) -> bool {
    let mut key = 0;
    while key < KEYS.len() {
        let path = KEYS[key].path.as_bytes();
        let mut same = 0;
        while start + same < end && same < path.len() && text[start + same] == path[same] {
            same += 1;
        }
        let whole = start + same == end;
        if whole && (same == path.len() || path[same] == b'.' || path[same] == b'[') {
            return true;
        }
        key += 1;
    }
    false
}

/// Whether the path is that of a list of sections.
pub fn is_list(path: &str) -> bool {
    KEYS.iter().any(|key| key.path.strip_prefix(path).is_some_and(|rest| rest.starts_with("[]")))
}

impl Form {
    /// What the form allows, as a noun phrase.
    pub fn allowed(&self, unit: &str) -> String {
        let unit = match unit {
            "" | "-" => String::new(),
            unit => format!(" {unit}"),
        };
        match self {
            Number(range) => format!("a number {range}{unit}"),
            Count(low, high) => format!("a whole number from {low} to {high}"),
            Flag => "true or false".into(),
            Word(words) => {
                let quoted: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
                quoted.join(" or ")
            }
            Text => "text in quotes".into(),
            Crown(range) => format!("\"flat\" or a number {range}{unit}"),
            Stiffness => {
                let [factor, areal, stability] = STIFFNESS;
                format!(
                    "a number {}, {{ stiffness = ... }} {} N/m^3, or {{ stability = ... }} {}",
                    factor.1, areal.1, stability.1
                )
            }
            Form::Curve => {
                "the path of a CSV file or a list of pairs [slip velocity, coefficient]".into()
            }
            Points => format!("a list of pairs of numbers between -10 and 10{unit}"),
        }
    }
}
