//! The case against itself: sizes that fit, choices that agree, a path that stays in the fine zone.

mod geometry;
mod half_space;
mod sideways;

use crate::case::check::raise;
use crate::case::error::{CaseError, KeyError};
use crate::case::friction_law;
use crate::case::hertz::{dundurs_beta, hertz};
use crate::case::key::number;
use crate::case::keys::{self, KEYS};
use crate::case::layers::{Layers, Origin, get, key_error_in};
use crate::case::name;
use crate::case::schema::{
    BodyModel, Case, Enforcement, LoadMode, PreloadMethod, Stiffness, Window,
};
use crate::case::units::{digits, mistaken};
use friction::Expression;
use friction::{DYNAMIC, LAWS, Mode, Parameters, STATIC};
use toml::{Table, Value};

/// More steps than the first are taken for a typing mistake; more than the second deserve a warning.
const MOST_STEPS: f64 = 1e9;
const MANY_STEPS: f64 = 1e7;

/// An interval between records that is shorter than this part of the estimated time step is taken for a typing
/// mistake: there can be one record at every step at most.
const SHORTEST: f64 = 1e-3;

/// More snapshots of fields or contact, more rows of the history and more numbers of probes than these are taken
/// for a typing mistake: they fill any disk.
const MOST_RECORDS: f64 = 1e7;
const MOST_ROWS: f64 = 1e8;
const MOST_NUMBERS: f64 = 1e11;

/// Every probe is eleven datasets of `probes.h5`, and the time to create them grows with the square of their
/// number; every window is looked at in every step.
const MOST_PROBES: usize = 1000;
const MOST_WINDOWS: usize = 1000;

/// Elements longer than this many half axes of the patch leave it without a node most of the time: the mean normal force
/// then misses the load by up to all of it.
const LARGEST_ELEMENT: f64 = 4.0;

/// A formula is evaluated at every node in contact in every step, and some 200,000 times before.
const LONGEST_FORMULA: usize = 4000;

/// Young's modulus below this (Pa) and density outside these bounds (kg/m^3) are likely given in other units.
const SOFTEST: f64 = 5e5;
const LIGHTEST: f64 = 20.0;
const HEAVIEST: f64 = 2.5e4;

/// Findings about a case as a whole.
struct Findings<'a> {
    layers: &'a Layers,
    errors: Vec<KeyError>,
}

impl Findings<'_> {
    /// Refuses the case unless `fine`. The message points at the first of `keys` that an option gives, or else at
    /// the first that a file gives: keys with their defaults are not in the user's sight.
    fn require(
        &mut self,
        fine: bool,
        keys: &[&str],
        problem: impl FnOnce() -> String,
        remedy: &str,
    ) {
        if fine {
            return;
        }
        let written = || keys.iter().filter_map(|&key| Some((key, self.layers.origins.get(key)?)));
        let by_option = |at: &Origin| self.layers.sources[at.source].name == "--set";
        let written = written().find(|(_, at)| by_option(at)).or_else(|| written().next());
        let problem = problem();
        self.errors.push(match written {
            Some((key, origin)) => {
                let source = self.layers.sources[origin.source].clone();
                key_error_in(source, origin.value.clone(), key, &problem, remedy)
            }
            None => self.layers.error_nowhere(keys[0], &problem, remedy),
        });
    }
}

/// Checks the case against itself: sizes that fit, choices that agree, a path that stays in the
/// fine zone. `layers` are those that the case was read from.
///
/// # Errors
/// All contradictions found, the first with the others in [`KeyError::others`].
pub fn check(case: &Case, layers: &Layers) -> Result<(), CaseError> {
    let mut found = Findings { layers, errors: Vec::new() };
    check_name(case, &mut found);
    check_choices(case, &mut found);
    match case.model {
        BodyModel::FiniteElements => geometry::check(case, &mut found),
        BodyModel::HalfSpace => half_space::check_zone(case, &mut found),
    }
    check_output(case, &mut found);
    // The path is judged only for a case whose shape makes sense.
    if found.errors.is_empty() {
        check_path(case, &mut found);
        if !case.is_half_space() {
            sideways::check_drift(case, &mut found);
        }
        check_formula(case, &mut found);
        check_length(case, &mut found);
        check_records(case, &mut found);
    }
    raise(found.errors)
}

fn check_name(case: &Case, found: &mut Findings) {
    let refused = name::refused(&case.name);
    found.require(refused.is_none(), &["name"], || refused.unwrap_or_default(), name::REMEDY);
}

fn check_choices(case: &Case, found: &mut Findings) {
    check_rules(case, found);
    check_friction(&case.friction, found);
    match case.model {
        BodyModel::FiniteElements => sideways::check(case, found),
        BodyModel::HalfSpace => half_space::check(case, found),
    }
    found.require(
        case.drive.ramp.is_none() || case.drive.rises(),
        &["drive.ramp", "drive.creepage"],
        || "drive.ramp is not used where drive.creepage is a table over time".into(),
        "leave drive.ramp out: the table says how the creepage rises",
    );
    let friction = &case.friction;
    let exact = case.contact.enforcement == Enforcement::Exact;
    let implicit = case.theta().is_some();
    found.require(
        exact || !implicit,
        &["time.integrator", "contact.enforcement"],
        || {
            "time.integrator = \"implicit\" does not go with contact.enforcement = \"penalty\": it solves the conditions of exact \
             contact"
                .into()
        },
        "set contact.enforcement = \"exact\", or leave time.integrator out",
    );
    found.require(
        case.time.step.is_some() || !implicit,
        &["time.integrator", "time.factor", "time.step"],
        || {
            "time.integrator = \"implicit\" needs time.step: it has no stability limit that a step could be a fraction of"
                .into()
        },
        "give time.step in seconds, such as 2.5e-6; while a node passes an element of the fine zone there should be \
         several steps",
    );
    if friction.mode == Some(Mode::Exact) {
        found.require(
            exact || case.is_half_space(),
            &["friction.mode", "contact.enforcement"],
            || "friction.mode = \"exact\" needs exact enforcement of contact".into(),
            "set contact.enforcement = \"exact\", or friction.mode = \"lagged\"",
        );
        found.require(
            friction.memory.is_none(),
            &["friction.mode", "friction.memory"],
            || {
                "friction.mode = \"exact\" and friction.memory are both given: friction with memory \
                 does not depend on the slip velocity of the instant"
                    .into()
            },
            "leave one of them out",
        );
    }
    found.require(
        case.element.hourglass > 0.0 || case.preload.method != PreloadMethod::Static,
        &["element.hourglass"],
        || {
            "element.hourglass = 0 leaves the elements without stiffness against hourglassing: the \
             static preload has no solution"
                .into()
        },
        "raise element.hourglass to 0.05, its default; 0.01 to 0.1 is the sensible range",
    );
    found.require(
        !exact || case.preload.method != PreloadMethod::Relaxation,
        &["preload.method", "contact.enforcement"],
        || {
            "preload.method = \"relaxation\" needs contact springs, and exact enforcement has none"
                .into()
        },
        "set preload.method = \"static\"",
    );
    found.require(
        !case.mesh.plane_strain || case.preload.method != PreloadMethod::Relaxation,
        &["preload.method", "mesh.plane_strain"],
        || {
            "preload.method = \"relaxation\" lets every node move across, and mesh.plane_strain = true \
             holds them in the plane"
                .into()
        },
        "set preload.method = \"static\"",
    );
    let preloaded = case.preload.method != PreloadMethod::None;
    found.require(
        case.disk.lift == 0.0 || !preloaded,
        &["disk.lift"],
        || {
            format!(
                "disk.lift = {} m: the disk does not touch the bar, so it cannot be preloaded",
                number(case.disk.lift)
            )
        },
        "leave disk.lift out (0: the disk touches), or drop the disk with preload.method = \"none\"",
    );
    found.require(
        case.load.mode == LoadMode::Load || preloaded,
        &["load.mode"],
        || "load.mode = \"height\" holds the height of the preload, but there is none".into(),
        "set preload.method = \"static\", or load.mode = \"load\"",
    );
}

/// No key is given that another makes useless, and none is missing that another needs.
fn check_rules(case: &Case, found: &mut Findings) {
    // A case holds nothing that TOML cannot.
    let given = Table::try_from(case).unwrap_or_default();
    for key in KEYS {
        let (path, is_given) = (key.path, get(&given, key.path).is_some());
        let rival = key.instead_of.filter(|other| is_given && get(&given, other).is_some());
        if let Some(other) = rival {
            let both = || format!("{path} and {other} are both given");
            found.require(path > other, &[path, other], both, "give one of them, not both");
            continue;
        }
        let Some((other, words)) = key.only else { continue };
        let now = get(&given, other);
        let word = now.and_then(Value::as_str).unwrap_or_default();
        let used = now.is_some() && (words.is_empty() || words.contains(&word));
        let (problem, remedy) = match words {
            [] => (format!("without {other}"), format!("give {other}")),
            _ => (
                format!("with {}", quoted(other, &[word])),
                format!("set {}", quoted(other, words)),
            ),
        };
        found.require(
            used || !is_given,
            &[path, other],
            || format!("{path} is not used {problem}"),
            &format!("{remedy}, or leave {path} out"),
        );
        let section = path.split('.').next().unwrap_or(path);
        let allowed = key.form.allowed(key.unit);
        found.require(
            !key.needed || !used || is_given,
            &[other, section],
            || format!("{path} is missing: {} needs it, {allowed}", quoted(other, &[word])),
            &format!("in [{section}] {}", key.remedy),
        );
    }
}

/// `KEY = "WORD"`, with all words that the key may be.
fn quoted(key: &str, words: &[&str]) -> String {
    let words: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
    format!("{key} = {}", words.join(" or "))
}

/// The friction law has the keys that it uses, no others, and they agree.
fn check_friction(friction: &Parameters, found: &mut Findings) {
    let uses = friction.declaration();
    let law = format!("friction.law = \"{}\"", uses.word);
    for key in friction.given().filter(|key| !uses.has(key)) {
        let path = friction_law::path(key);
        let others = LAWS.iter().filter(|other| other.has(key)).map(|other| other.word);
        found.require(
            false,
            &[&path],
            || format!("{path} is not used with {law}"),
            &format!(
                "leave it out, or set {}",
                quoted("friction.law", &others.collect::<Vec<_>>())
            ),
        );
    }
    for key in uses.needs().filter(|&key| !friction.given().any(|given| given == key)) {
        let path = friction_law::path(key);
        let row = keys::find(&path);
        let allowed = row.map_or(String::new(), |row| row.form.allowed(row.unit));
        found.require(
            false,
            &["friction.law", "friction"],
            || format!("{path} is missing: {law} needs it, {allowed}"),
            &format!("in [friction] {}", row.map_or("give it", |row| row.remedy)),
        );
    }
    if uses.has("dynamic") {
        let (rest, dynamic) = (friction.value(STATIC), friction.value(DYNAMIC));
        found.require(
            dynamic <= rest,
            &["friction.dynamic", "friction.static"],
            || {
                format!(
                    "friction.dynamic = {} must be at most friction.static = {}",
                    number(dynamic),
                    number(rest)
                )
            },
            "friction falls with slip velocity in this law: swap the two coefficients",
        );
    }
}

/// A formula gives a coefficient of friction at every pressure, time and place of the case.
fn check_formula(case: &Case, found: &mut Findings) {
    let Some(text) = &case.friction.expression else { return };
    let length = text.chars().count();
    found.require(
        length <= LONGEST_FORMULA,
        &["friction.expression"],
        || {
            format!(
                "friction.expression has {length} characters, more than {LONGEST_FORMULA}: it is evaluated \
                 at every node in contact in every step"
            )
        },
        "give a measured curve as friction.table, which may have any length, or write a shorter formula",
    );
    if length > LONGEST_FORMULA {
        return;
    }
    let wrong = Expression::over(text, &friction_law::domain(case)).err();
    found.require(
        wrong.is_none(),
        &["friction.expression"],
        || {
            let problem = wrong.as_ref().map(ToString::to_string).unwrap_or_default();
            format!("friction.expression: {problem}")
        },
        "write a formula that is a coefficient of friction everywhere: max(p, 1e3) keeps clear of a \
         division by zero, max(0.1, ...) of a negative value",
    );
}

fn check_output(case: &Case, found: &mut Findings) {
    let rolled = case.rolled();
    let last = case.evaluate_last();
    let key = if case.evaluate.transits.is_some() { "evaluate.transits" } else { "evaluate.last" };
    found.require(
        last <= rolled * (1.0 + 1e-12),
        &[key, "time.roll", "time.duration"],
        || {
            let transits =
                case.evaluate.transits.map(|transits| format!("{} transits, ", number(transits)));
            format!(
                "{key} = {}{} m must be at most the rolled distance, {} m",
                transits.unwrap_or_default(),
                number(round(last)),
                number(round(rolled))
            )
        },
        "evaluate a shorter stretch, or roll further",
    );
    let windows = case.output.window.len();
    found.require(
        windows <= MOST_WINDOWS,
        &["output.window"],
        || {
            format!(
                "output.window has {windows} entries, more than {MOST_WINDOWS}: each is looked at in \
                 every step"
            )
        },
        "join windows that follow each other, or shorten output.contact_interval",
    );
    for (i, window) in case.output.window.iter().enumerate() {
        let to = format!("output.window[{i}].to");
        found.require(
            window.to > window.from,
            &[&to],
            || {
                format!(
                    "{to} = {} s must be greater than its from = {} s",
                    number(window.to),
                    number(window.from)
                )
            },
            "a window ends after it begins",
        );
    }
    check_probes(case, found);
}

/// A probe is recorded at the nearest node of the fine zone, so it must be there.
fn check_probes(case: &Case, found: &mut Findings) {
    let zone = &case.mesh.zone;
    let [rear, front] = case.mesh.zone_along();
    let travel = if case.mesh.window.is_some() { case.rolled() } else { 0.0 };
    let (rear, front) = (rear - zone.size, front + travel + zone.size);
    let half = 0.5 * zone.width + zone.size;
    let probes = &case.output.probes;
    for (key, points, along) in
        [("output.probes.bar", &probes.bar, "x"), ("output.probes.disk", &probes.disk, "s")]
    {
        found.require(
            points.len() <= MOST_PROBES,
            &[key],
            || {
                format!(
                    "{key} has {} points, more than {MOST_PROBES}: each is eleven datasets, and the time \
                     to create them grows with the square of their number",
                    points.len()
                )
            },
            "record all nodes of the fine zone at every step of a while instead: [[output.window]]",
        );
        let outside = points.iter().find(|[x, y]| *x < rear || *x > front || y.abs() > half);
        found.require(
            outside.is_none(),
            &[key],
            || {
                let [x, y] = outside.copied().unwrap_or_default();
                format!(
                    "{key} = [{}, {}] m must lie in the fine zone: {along} from {} to {} m, y \
                     from {} to {} m",
                    number(x),
                    number(y),
                    number(round(rear + zone.size)),
                    number(round(front - zone.size)),
                    number(round(-0.5 * zone.width)),
                    number(round(0.5 * zone.width))
                )
            },
            "contact is recorded in the fine zone: move the point, or enlarge mesh.zone",
        );
    }
}

/// Time steps of the run, roughly: the smallest element over the speed of pressure waves. The
/// stable step of the mesh is not known before the mesh is.
fn steps(case: &Case) -> f64 {
    case.duration() / case.step().under(case.wave_time())
}

/// The run does not need more steps than anybody waits for.
fn check_length(case: &Case, found: &mut Findings) {
    let steps = steps(case);
    found.require(
        steps <= MOST_STEPS,
        &[
            "time.duration",
            "time.factor",
            "time.step",
            "drive.speed",
            "mesh.zone.size",
            "time.roll",
        ],
        || {
            format!(
                "the run of {} s needs about {steps:.1e} time steps, more than {MOST_STEPS:.0e}: \
                 at a millisecond each that is {:.0} days",
                digits(case.duration()),
                steps * 1e-3 / 86400.0
            )
        },
        "roll faster (drive.speed) or less (time.roll, time.duration), or use larger elements \
         (mesh.zone.size)",
    );
}

/// Records must be a step apart at least, and a disk must hold them.
fn check_records(case: &Case, found: &mut Findings) {
    let steps = steps(case);
    let (duration, output) = (case.duration(), &case.output);
    let step = duration / steps;
    let rolled = if case.time.duration.is_some() { "time.duration" } else { "time.roll" };
    found.require(
        duration >= SHORTEST * step,
        &[rolled],
        || {
            format!(
                "{rolled} makes a run of {} s, far below the time step, which is about {step:.0e} s",
                number(duration)
            )
        },
        "roll further: 0.06 m, or 1.5e-3 s",
    );
    let [from, to] = case.evaluation_window();
    let window =
        if case.evaluate.transits.is_some() { "evaluate.transits" } else { "evaluate.last" };
    found.require(
        to - from >= SHORTEST * step.min(duration),
        &[window],
        || {
            format!(
                "{window} makes an evaluation window of {} s, far below the time step, which is about {step:.0e} s: \
                 no step ends in it, and no mean has a value",
                number(to - from)
            )
        },
        "take the means over a longer stretch: evaluate.last = 0.02",
    );
    let intervals = [
        ("output.fields_interval", Some(case.fields_interval())),
        ("output.contact_interval", Some(output.contact_interval)),
        ("checkpoint.time", case.checkpoint.time),
    ];
    for (key, interval) in intervals {
        let interval = interval.unwrap_or(f64::INFINITY);
        found.require(
            interval >= SHORTEST * step.min(duration),
            &[key],
            || {
                format!(
                    "{key} = {} s is far below the time step, which is about {step:.0e} s: there can be one \
                     at every step at most",
                    number(interval)
                )
            },
            "give the time between two of them in seconds: 5.7e-6 for 5.7 microseconds",
        );
    }
    let mut at_most = |most: f64, count: f64, key: &str, what: &str, remedy: &str| {
        found.require(
            count <= most,
            &[key],
            || {
                format!(
                    "{key} makes about {count:.0e} {what} in {steps:.0e} steps, more than {most:.0e}: \
                     no disk holds them"
                )
            },
            remedy,
        );
    };
    let every = |interval: f64| (duration / interval).min(steps);
    const LONGER: &str = "make the interval longer, or roll less (time.roll, time.duration)";
    let fields = every(case.fields_interval());
    at_most(MOST_RECORDS, fields, "output.fields_interval", "snapshots of both bodies", LONGER);
    let contact = every(output.contact_interval);
    at_most(MOST_RECORDS, contact, "output.contact_interval", "snapshots of contact", LONGER);
    let in_window = |w: &Window| {
        let steps = steps * ((w.to.min(duration) - w.from) / duration).max(0.0);
        steps / w.every as f64
    };
    let windows = output.window.iter().map(in_window).sum();
    const SHORTER: &str = "shorten the windows, or give `every` more steps";
    at_most(MOST_RECORDS, windows, "output.window", "snapshots of contact", SHORTER);
    let rows = steps / output.history_interval as f64;
    at_most(MOST_ROWS, rows, "output.history_interval", "rows of the history", LONGER);
    for (key, probes) in
        [("output.probes.bar", &output.probes.bar), ("output.probes.disk", &output.probes.disk)]
    {
        let numbers = 11.0 * steps * probes.len() as f64;
        at_most(
            MOST_NUMBERS,
            numbers,
            key,
            "numbers",
            "give fewer points, or roll less (time.roll)",
        );
    }
}

/// Warnings about intervals and an evaluation window that are shorter than the time step `dt` (s), one sentence each. The
/// default interval of a very short run gives none.
pub fn below_the_step(case: &Case, dt: f64) -> Vec<String> {
    let default = case.duration() / Case::SNAPSHOTS;
    let [from, to] = case.evaluation_window();
    let window = (to - from < dt).then(|| {
        format!(
            "the evaluation window of {:.2e} s is shorter than the time step, {dt:.2e} s: it may hold no step, and the \
             means then have no value",
            to - from
        )
    });
    [
        ("output.fields_interval", Some(case.fields_interval())),
        ("output.contact_interval", Some(case.output.contact_interval)),
        ("checkpoint.time", case.checkpoint.time),
    ]
    .into_iter()
    .filter_map(|(key, interval)| Some((key, interval?)))
    .filter(|&(_, interval)| interval < dt && interval < 0.999 * default)
    .map(|(key, interval)| {
        format!(
            "{key} = {} s is shorter than the time step, {dt:.2e} s: there is one at every step",
            number(interval)
        )
    })
    .chain(window)
    .collect()
}

/// Warnings about values that look as if given in another unit, one sentence each.
fn units(case: &Case) -> Vec<String> {
    let mut found = Vec::new();
    for (body, own, material) in [
        ("disk", &case.disk.material, case.disk_material()),
        ("bar", &case.bar.material, case.bar_material()),
    ] {
        let path = |key: &str, is_own: bool| {
            if is_own { format!("{body}.material.{key}") } else { format!("material.{key}") }
        };
        let young = path("young", own.young.is_some());
        let density = path("density", own.density.is_some());
        if material.young < SOFTEST {
            found.push(format!(
                "{young} = {} Pa is softer than rubber: is it in MPa? steel has 210e9 Pa",
                number(material.young)
            ));
        }
        if material.density < LIGHTEST {
            found.push(format!(
                "{density} = {} kg/m^3 is lighter than foam: is it in g/cm^3? steel has 7850 kg/m^3",
                number(material.density)
            ));
        } else if material.density > HEAVIEST {
            found.push(format!(
                "{density} = {} kg/m^3 is heavier than any metal: steel has 7850 kg/m^3",
                number(material.density)
            ));
        }
    }
    found.sort();
    found.dedup();
    found
}

/// A length in millimetres.
fn mm(x: f64) -> String {
    digits(1e3 * x)
}

/// The shorter half axis of the patch (m) that elements must resolve; a slice has none across.
fn least_half_axis(case: &Case) -> f64 {
    let patch = hertz(case);
    if case.mesh.plane_strain { patch.a } else { patch.a.min(patch.b) }
}

/// The patch, by Hertz, must not be lost in one element, and must stay inside the fine zone while rolling from x = 0.
fn check_path(case: &Case, found: &mut Findings) {
    // a wrong unit is the likely cause of an absurd patch
    let units = units(case).into_iter().map(|unit| format!("; {unit}")).collect::<String>();
    let help = |remedy: &str| format!("{remedy}{units}");
    let zone = &case.mesh.zone;
    let patch = hertz(case);
    let (rear, front) = (-patch.a, case.rolled() + patch.a);
    let follows = case.mesh.window.is_some();
    let least = least_half_axis(case);
    // half-spaces count points in the patch; a disk that falls presses harder than its load; a mesh that is read can not be
    // refined here, and a run on it says what it misses
    let generated = !case.is_half_space() && case.mesh.file.is_none();
    let rests = generated && case.preload.method != PreloadMethod::None;
    found.require(
        !rests || zone.size <= LARGEST_ELEMENT * least,
        &["load.normal", "mesh.zone.size", "material.young"],
        || {
            format!(
                "mesh.zone.size = {} mm is more than twice the shorter axis of the patch of load.normal = {} N, {} \
                 by {} mm by Hertz: one node or none touches, and its force does not balance the load",
                mm(zone.size),
                number(case.load.normal),
                mm(2.0 * patch.a),
                mm(2.0 * patch.b)
            )
        },
        &help(&format!(
            "raise load.normal, or set mesh.zone.size = {} or less, a quarter of the patch",
            digits(0.5 * least)
        )),
    );
    found.require(
        follows || zone.start <= rear,
        &["mesh.zone.start", "load.normal", "material.young"],
        || {
            format!(
                "mesh.zone.start = {} m must be at most {} m: the patch at the start reaches \
                 back so far",
                number(zone.start),
                digits(rear)
            )
        },
        &help("start the fine zone further back, or reduce the load"),
    );
    let end = zone.start + zone.length;
    found.require(
        follows || end >= front,
        &[
            "time.roll",
            "time.duration",
            "mesh.zone.length",
            "mesh.zone.start",
            "load.normal",
            "material.young",
        ],
        || {
            format!(
                "the patch (half length {} mm) ends at x = {} m after rolling {} m, \
                 but the fine zone ends at {} m",
                digits(1e3 * patch.a),
                digits(front),
                number(round(case.rolled())),
                number(round(end))
            )
        },
        &help(
            "roll less (time.roll), lengthen the fine zone (mesh.zone.length), or let it follow the contact (mesh.window)",
        ),
    );
    found.require(
        case.window_columns() != Some(0),
        &["mesh.window", "mesh.zone.size", "load.normal", "material.young"],
        || {
            format!(
                "mesh.window = {} m must be at least {} m: the patch (half length {} mm) with room to move on by one \
                 element",
                number(case.mesh.window.unwrap_or_default()),
                digits(case.shortest_window()),
                digits(1e3 * patch.a)
            )
        },
        &help("lengthen the window: three patches are sensible"),
    );
    found.require(
        zone.width >= 2.0 * patch.b * (1.0 - 1e-12),
        &["mesh.zone.width", "load.normal", "material.young"],
        || {
            format!(
                "mesh.zone.width = {} m must be at least the patch's width, {} m",
                number(zone.width),
                digits(2.0 * patch.b)
            )
        },
        &help("widen the fine zone, reduce the load, or give the bar a smaller crown_radius"),
    );
}

/// Rounded to nanometres, so that a sum such as -0.01 + 0.08 is shown as it was meant.
fn round(x: f64) -> f64 {
    (x * 1e9).round() / 1e9
}

/// What is allowed but deserves a warning.
pub fn warnings(case: &Case) -> Vec<String> {
    let mut warnings = Vec::new();
    let mut warn = |condition: bool, text: String| {
        if condition {
            warnings.push(text);
        }
    };
    case.left_out.warning(case.model).into_iter().for_each(|left_out| warn(true, left_out));
    units(case).into_iter().for_each(|unit| warn(true, unit));
    mistaken(&case.table()).into_iter().for_each(|unit| warn(true, unit));
    warn(
        case.element.hourglass == 0.0,
        "element.hourglass = 0: nothing holds the elements against hourglassing".into(),
    );
    let factor = case.factor();
    warn(
        factor > 1.0 && !case.is_half_space(),
        format!("time.factor = {factor} is above 1: THE RUN IS UNSTABLE and will blow up"),
    );
    let steps = steps(case);
    warn(
        steps > MANY_STEPS,
        format!(
            "the run needs about {steps:.1e} time steps, at a millisecond each {:.0} hours",
            steps * 1e-3 / 3600.0
        ),
    );
    let patch = hertz(case);
    let size = case.mesh.zone.size;
    warn(
        size > 0.5 * least_half_axis(case),
        format!(
            "mesh.zone.size = {} mm is coarse for a patch of half axes {} and {} mm",
            mm(size),
            mm(patch.a),
            mm(patch.b)
        ),
    );
    let beta = dundurs_beta(case);
    warn(
        beta.abs() > 1e-6,
        format!(
            "the materials of disk and bar differ (Dundurs' beta {beta:.3}): creepage 0 is not free rolling, and creep-force \
             curves are shifted by the creepage that a run with drive.torque = 0 finds"
        ),
    );
    warn(
        case.drive.rises() && case.drive.ramp() > case.evaluation_window()[0],
        format!(
            "the evaluation window begins at {} ms, before the drive's ramp ends at {} ms",
            digits(1e3 * case.evaluation_window()[0]),
            digits(1e3 * case.drive.ramp())
        ),
    );
    let [from, _] = case.evaluation_window();
    warn(
        case.drive.creepage.as_ref().is_some_and(|creepage| creepage.changes_after(from)),
        format!(
            "drive.creepage still changes after {} ms, where the evaluation window begins: means are over the change",
            digits(1e3 * from)
        ),
    );
    for (key, stiffness) in
        [("normal", case.contact.penalty.normal), ("tangential", case.contact.penalty.tangential)]
    {
        if let Stiffness::Stability(fraction) = stiffness {
            warn(
                fraction > 1.0,
                format!("contact.penalty.{key} is {fraction} of the stability limit: unstable"),
            );
        }
    }
    for window in &case.output.window {
        warn(
            window.from >= case.duration(),
            format!(
                "an output window begins at {} s, after the end of the run at {} s",
                number(window.from),
                digits(case.duration())
            ),
        );
    }
    warnings
}
