//! A slice in plane strain: the contact of two cylinders.

use runs::{Results, load, project, run};
use std::collections::BTreeMap;

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

/// Every law, enforcement and element that a slice may have.
const SLICES: [&[&str]; 11] = [
    &["contact.enforcement=penalty", "element.contact_layers=one-point"],
    &["contact.enforcement=penalty", "friction.law=exponential"],
    &["contact.enforcement=exact", "element.volumetric=full"],
    &["contact.enforcement=exact", "friction.law=exponential", "friction.mode=exact"],
    &["contact.enforcement=exact", "friction.law=exponential", "element.contact_layers=one-point"],
    &["contact.enforcement=exact", "friction.law=exponential", "friction.memory.distance=1e-6"],
    &["contact.enforcement=exact", "friction.law=slip_weakening", "friction.distance=5e-6"],
    &["contact.enforcement=exact", "friction.law=prakash_clifton", "friction.distance=2e-6"],
    &["contact.enforcement=exact", "friction.law=rate_state", "friction.distance=5e-6"],
    &[
        "contact.enforcement=exact",
        "friction.law=expression",
        "friction.expression=\"0.3 + 0.2*exp(-2*s)\"",
    ],
    &["contact.enforcement=exact", "friction.law=exponential", "contact.rows=mortar"],
];

/// Rows of the nodes that face each other across the slice, by x and z, those of the disk before those of
/// the bar where both touch.
fn across(points: &[f64]) -> Vec<[usize; 2]> {
    let mut at: BTreeMap<[u64; 2], Vec<usize>> = BTreeMap::new();
    for (node, x) in points.chunks(3).enumerate() {
        at.entry([x[0].to_bits(), x[2].to_bits()]).or_default().push(node);
    }
    at.values().flat_map(|nodes| nodes.chunks(2).map(|pair| [pair[0], pair[1]])).collect()
}

/// The largest difference between the nodes of any of `pairs`, over the largest value.
fn apart(values: &[f64], pairs: &[[usize; 2]], nodes: usize) -> f64 {
    let components = values.len() / nodes;
    let differences = pairs.iter().flat_map(|&[a, b]| {
        (0..components).map(move |i| values[a * components + i] - values[b * components + i])
    });
    let largest = values.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
    differences.fold(0.0, |most: f64, d| most.max(d.abs())) / largest
}

#[test]
fn nodes_across_a_slice_move_as_one_with_every_law_and_element() {
    for sets in SLICES {
        let found = slice(&[&["output.contact_interval=2e-6"], sets].concat());
        assert_eq!(found.summary["status"], "completed", "{sets:?}");
        // Of mortar rows on the slaves alone, the disk's nodes: what the bar's nodes receive is a mean by integrals
        // that each slave takes anew when it has moved so far, round-off before or after its neighbour across.
        let mortar = sets.contains(&"contact.rows=mortar");
        let slaves = found.nodes_of_disk();
        for (grid, fields, most) in [
            ("fields", &["displacement", "velocity"][..], 0.0),
            ("contact", &["displacement", "velocity", "state"], 0.0),
            ("contact", &["pressure", "shear", "slip_velocity", "mu", "gap"], 1e-10),
        ] {
            let points = &found.data[&format!("{grid}/points")];
            let mut pairs = across(points);
            assert_eq!(2 * pairs.len(), points.len() / 3);
            if mortar && most > 0.0 {
                pairs.retain(|pair| pair[1] < slaves);
                assert!(!pairs.is_empty());
            }
            for field in fields {
                let of_field = format!("{grid}/{field}/");
                let steps = found.data.iter().filter(|(name, _)| name.starts_with(&of_field));
                for (name, values) in steps {
                    let apart = apart(values, &pairs, points.len() / 3);
                    assert!(apart <= most, "{sets:?} {name}: {apart:e}");
                }
            }
        }
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
