//! Line contact, and patches that no distribution of Hertz fits.

use runs::{Results, small};
use serde_json::Value;

const SHORT: [&str; 1] = ["time.roll=0.001"];

fn run(sets: &[&str]) -> Results {
    small(&[&SHORT, sets].concat())
}

#[test]
fn bodies_flat_across_have_the_width_of_their_contact_and_the_peak_of_a_line() {
    // five elements along the patch, and springs as stiff as the bodies
    let flat = run(&[
        "bar.crown_radius=\"flat\"",
        "disk.width=0.0128",
        "mesh.zone.width=0.0128",
        "load.normal=60e3",
        "contact.penalty.normal=1.0",
    ]);
    let found = |key: &str| flat.number(&format!("/contact/{key}"));
    let hertz = |key: &str| flat.number(&format!("/half_space/{key}"));
    assert!((hertz("half_width") - 6.4e-3).abs() < 1e-12);
    let width = found("patch_half_width");
    assert!((width - 6.4e-3).abs() < 0.5 * 0.8e-3, "half the width of contact: {width}");
    let [length, peak] = [("patch_half_length", "half_length"), ("peak_pressure", "peak_pressure")]
        .map(|(key, reference)| found(key) / hertz(reference));
    // the free sides of the bodies and the coarse mesh take a tenth of the peak
    assert!((length - 1.0).abs() < 0.05, "{length}");
    assert!((peak - 1.0).abs() < 0.15, "{peak}");
    let area = 4.0 * found("patch_half_length") * width;
    assert!(
        (found("patch_area_fitted") / area - 1.0).abs() < 1e-3,
        "a rectangle's area, not {area}"
    );
    // the distribution bears the load but for what the mesh smears around it: pi/2 a p0 times the width
    let borne = std::f64::consts::PI * found("patch_half_length") * found("peak_pressure") * width;
    assert!((borne / found("normal_force") - 1.0).abs() < 0.15, "{borne}");
    assert!(flat.number("/window/stick_border") < 0.0);
}

#[test]
fn a_patch_that_nothing_fits_has_no_half_axes_and_says_why() {
    // half axes of half an element: too few nodes carry pressure
    let tiny = run(&["load.normal=100"]);
    assert_eq!(tiny.summary["status"], "completed");
    for key in ["patch_half_length", "patch_half_width", "patch_area_fitted", "peak_pressure"] {
        assert_eq!(tiny.summary["contact"].get(key), Some(&Value::Null), "{key}");
        assert_eq!(tiny.summary["window"]["deviation"][key], Value::Null);
        let reason = tiny.summary["window"]["reasons"][key].as_str().unwrap();
        assert!(reason.contains("none of") && reason.contains("rows"), "{reason}");
    }
    assert_eq!(tiny.summary["window"]["stick_border"], Value::Null);
    assert!(tiny.summary["window"]["reasons"]["stick_border"].is_string());
    assert!(tiny.number("/contact/patch_area") > 0.0 && tiny.number("/contact/normal_force") > 0.0);
}
