//! A slice in plane strain: the contact of two cylinders.
#![allow(clippy::unwrap_used)]

use runs::{Results, load, project, run};

fn slice(sets: &[&str]) -> Results {
    let short =
        ["mesh.zone.size=2e-3", "mesh.zone.length=0.04", "time.roll=0.004", "drive.ramp=30e-6"];
    run(&load(&project("cases/verdict/slice.toml"), &[&short, sets].concat()), 2)
}

#[test]
fn a_slice_has_hertz_line_contact_and_nothing_moves_across_it() {
    let found = slice(&[]);
    assert_eq!(found.summary["status"], "completed");
    // Hertz's line contact of 1e7 N/m on R 0.46 m, by the closed form: a 7.125 mm, p0 893.6 MPa.
    // Seven elements along the patch: coarser by four than cases/verdict/slice.toml is meant to be.
    let (a, p0) =
        (found.number("/contact/patch_half_length"), found.number("/contact/peak_pressure"));
    assert!((a / 7.125e-3 - 1.0).abs() < 0.03, "{a}");
    assert!((p0 / 893.6e6 - 1.0).abs() < 0.06, "{p0}");
    assert!(found.number("/energy/balance_error") < 1e-3);
    for (name, values) in found.data.iter().filter(|(name, _)| name.contains("/displacement/")) {
        assert!(values.chunks(3).all(|u| u[1] == 0.0), "{name}");
    }
}

#[test]
fn the_width_of_a_slice_only_scales_its_forces() {
    let narrow = slice(&[]);
    let wide =
        slice(&["disk.width=6e-3", "bar.width=6e-3", "mesh.zone.width=6e-3", "load.normal=60e3"]);
    for key in ["peak_pressure", "patch_half_length"] {
        let pair = [&narrow, &wide].map(|run| run.number(&format!("/contact/{key}")));
        assert!((pair[1] / pair[0] - 1.0).abs() < 2e-3, "{key} {pair:?}");
    }
}
