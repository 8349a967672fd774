//! The coefficient that the algorithm used, against the law recomputed from the records, in runs with planted content.
use crate::planted::*;
use creepage::check::Report;
use serde_json::Value;

const EXACT: &str =
    "law = \"exponential\"\nstatic = 0.5\ndynamic = 0.32\ndecay = 6.0\nmode = \"exact\"";

/// Slip speed of every node that slips (m/s).
const SPEED_OF_SLIP: f64 = 0.2;

/// Writes a run with multipliers at the nodes of the disk and records at these steps, in which nodes slip all the time and
/// use the coefficient `used(x, step)`.
fn judged(friction: &str, steps: &[usize], used: impl Fn([f64; 3], usize) -> f64) -> Judged {
    let folder = tempfile::tempdir().unwrap();
    case(folder.path(), friction, "exact");
    let (s, leave) = (surfaces(), Leave::default());
    let path = folder.path().join("contact.vtkhdf");
    let mut file = create_with(&path, &s, leave, &[("enforced_on", "disk")]);
    let node = |x: [f64; 3], step: usize| {
        let (pressure, mu) = (hertz(x), used(x, step));
        if pressure <= 0.0 {
            return OPEN;
        }
        let (shear, slip) = ([-mu * pressure, 0.0, 0.0], [SPEED_OF_SLIP, 0.0, 0.0]);
        Node { pressure, shear, slip, gap: 0.0, mu, state: 2 }
    };
    for step in steps {
        append(&mut file, &s, *step, DT, leave, &node);
    }
    drop(file);
    judge(folder.path(), Report::Stricter).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// What Eq. (8) gives at the speed of the step before; contact begins at rest.
fn lagged(step: usize) -> f64 {
    mu(FALLING, if step == 0 { 0.0 } else { SPEED_OF_SLIP })
}

#[test]
fn with_every_step_recorded_the_law_is_known_and_an_error_of_the_coefficient_is_found() {
    let found = judged(FALLING, &[0, 1, 2, 3], |_, step| lagged(step));
    assert!(number(&found.document["metrics"]["mu_error"]["value"]) < 1e-12);
    let followed = &found.document["law_followed"];
    assert_eq!(followed["known"], 1.0, "{followed}");
    assert_eq!(followed["blurred"], 0.0, "{followed}");
    let found = judged(FALLING, &[0, 1, 2, 3], |x, step| {
        let planted = step == 2 && x[0].abs() < 1e-9 && x[1].abs() < 1e-9;
        lagged(step) * if planted { 1.03 } else { 1.0 }
    });
    let metric = &found.document["metrics"]["mu_error"];
    assert!((number(&metric["value"]) - 0.03).abs() < 1e-12, "{metric:#}");
    assert!((number(&metric["where"]["time"]) - 2.0 * DT).abs() < 1e-12, "{metric:#}");
    let law = lagged(2);
    assert!((number(&metric["where"]["mu_used"]) - 1.03 * law).abs() < 1e-12, "{metric:#}");
    assert!((number(&metric["where"]["mu_law"]) - law).abs() < 1e-12, "{metric:#}");
}

#[test]
fn between_records_two_steps_apart_the_law_is_known_between_half_and_twice_the_slip_and_the_note_says_so()
 {
    let found = judged(FALLING, &[0, 2, 4, 6], |_, step| lagged(step));
    // the first of four records, which begins with contact, is known
    let followed = &found.document["law_followed"];
    let blur = 1.0 - mu(FALLING, 2.0 * SPEED_OF_SLIP) / mu(FALLING, 0.5 * SPEED_OF_SLIP);
    let metric = &found.document["metrics"]["mu_error_blurred"];
    assert_eq!(metric["value"], 0.0, "the law at the slip speed itself lies between: {metric:#}");
    for detail in ["blur_median", "blur_p95"] {
        let told = number(&metric["sides"]["disk"][detail]);
        assert!((told - blur).abs() < 1e-12, "{detail}: {told} {blur}");
    }
    let notes = found.document["notes"].as_array().unwrap();
    let note =
        notes.iter().find_map(|note| note.as_str().filter(|note| note.contains("known only")));
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let (blurred, known) = (number(&followed["blurred"]), number(&followed["known"]));
    assert!((blurred + known - 1.0).abs() < 1e-12 && blurred > 0.5, "{followed}");
    for said in [
        format!("on {} of contact area and time", percent(blurred)),
        format!(
            "known only to {:.2} % (median; 95 % of it to {:.2} %)",
            100.0 * blur,
            100.0 * blur
        ),
        format!("on {} to round-off", percent(known)),
    ] {
        assert!(note.unwrap().contains(&said), "{said}: {note:?}");
    }
}

#[test]
fn the_round_off_of_recorded_slip_speeds_is_no_error_of_the_coefficient_and_more_than_it_is_one() {
    // recorded slip is known to 1e-11 of the rolling speed
    let round_off = 1e-11 * SPEED;
    for (part, is_error) in [(0.9, false), (-0.9, false), (2.0, true), (-2.0, true)] {
        let off = mu(FALLING, SPEED_OF_SLIP + part * round_off);
        let found = judged(EXACT, &[0, 1, 2], |_, _| off);
        let error = number(&found.document["metrics"]["mu_error"]["value"]);
        assert_eq!(error > 0.0, is_error, "{part}: {error:e}");
    }
}
