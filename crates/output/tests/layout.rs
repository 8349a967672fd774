//! The declared layout is the contract with readers outside, and what `docs/files.md` says.

#![allow(clippy::unwrap_used, missing_docs)]

use output::layout::{self, CONTACT, Pairing, attribute, file};
use output::summary::dotted_keys;

/// Names in the order of the files: scripts rely on them.
const NAMES: [(&str, &str); 5] = [
    (
        "fields.vtkhdf",
        "displacement deformation velocity stress von_mises max_shear hydrostatic principal body",
    ),
    (
        "contact.vtkhdf",
        "pressure shear slip_velocity slip mu state gap velocity displacement pass_pressure body area",
    ),
    (
        "history.h5",
        "time step kinetic internal hourglass contact_stored friction_dissipated damping_dissipated \
         external_work imbalance normal_force tangential_force lateral_force traction_coefficient creepage \
         omega torque drive_force hub_x hub_z patch_half_length patch_half_width patch_x peak_pressure \
         peak_pressure_raw peak_shear patch_area stick_fraction slip_fraction stick_border closed_pairs \
         slipping_pairs max_penetration cone_excess contact_damping sweeps manifold resultant_mismatch \
         window_x window_energy",
    ),
    (
        "probes.h5",
        "time probe0_pressure probe0_shear_x probe0_shear_y probe0_shear_z probe0_slip_velocity_x \
         probe0_slip_velocity_y probe0_slip_velocity_z probe0_slip_x probe0_mu probe0_state probe0_gap",
    ),
    (
        "postmortem.vtkhdf",
        "displacement velocity force suspect volume_ratio corner_ratio strain_energy hourglass_energy suspect \
         body",
    ),
];

#[test]
fn names_and_their_order_are_those_that_scripts_rely_on() {
    for ((file, fields), (wanted, names)) in layout::files().iter().zip(NAMES) {
        let found: Vec<&str> = fields.iter().map(|field| &*field.name).collect();
        assert_eq!((*file, found.join(" ")), (wanted, names.to_owned()));
    }
    let root = "creepage_version case_hash created slip_pairing enforced_on contact_rows symmetry \
                window diagnosis";
    assert_eq!(attribute::ALL.map(|(name, _)| name).join(" "), root);
}

#[test]
fn contact_says_which_step_its_slip_is_of_and_has_passes_with_springs_alone() {
    let described = |pairing, name: &str| {
        let field = CONTACT.of_run(pairing).into_iter().find(|field| field.name == name);
        field.map(|field| field.description.into_owned())
    };
    let text = |text: &str| Some(text.to_owned());
    let before = described(Pairing::Before, "slip_velocity");
    assert_eq!(before, text("velocity of this surface relative to the other, over the last step"));
    assert_eq!(described(Pairing::After, "velocity"), text("velocity over the next step"));
    assert!(described(Pairing::Before, "pass_pressure").is_some());
    assert_eq!(described(Pairing::After, "pass_pressure"), None);
}

/// The block of the document between the markers of `name`, replaced.
fn with_block(document: &str, name: &str, block: &str) -> String {
    let start = format!("<!-- layout: {name} -->\n");
    let (head, rest) = document.split_once(&start).unwrap_or_else(|| panic!("no block {name}"));
    let (_, tail) = rest.split_once("<!-- end of layout -->").unwrap();
    format!("{head}{start}{block}<!-- end of layout -->{tail}")
}

/// Compares a document with what it should be; `BLESS=1` writes it instead.
fn compare(path: &str, document: &str, wanted: &str) {
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(path, wanted).unwrap();
    } else {
        assert!(document == wanted, "{path} differs from its declaration in crates/output/src");
    }
}

// a bar would end a cell
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

#[test]
fn the_document_has_the_tables_of_the_declaration() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/files.md");
    let document = std::fs::read_to_string(path).unwrap();
    let mut wanted = document.clone();
    for (file, fields) in layout::files() {
        let mut table = String::from("| dataset | units | shape | meaning |\n|---|---|---|---|\n");
        for field in fields {
            let (name, meaning) = (&field.name, cell(&field.description));
            table += &format!("| `{name}` | {} | {} | {meaning} |\n", field.units, field.shape());
        }
        wanted = with_block(&wanted, file, &table);
    }
    let lines = attribute::ALL.map(|(name, meaning)| format!("| `{name}` | {meaning} |\n"));
    let table = format!("| attribute | meaning |\n|---|---|\n{}", lines.concat());
    wanted = with_block(&wanted, "attributes", &table);
    compare(path, &document, &wanted);
    for (file, _) in file::ALL {
        assert!(document.contains(&format!("| `{file}` |")), "{file}");
    }
}

#[test]
fn the_table_of_the_summary_has_every_key_with_its_unit_and_meaning() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/tables/summary.md");
    let document = std::fs::read_to_string(path).unwrap();
    let mut table = String::from("| key | units | meaning |\n|---|---|---|\n");
    for (key, quantity) in dotted_keys() {
        table += &format!("| `{key}` | {} | {} |\n", quantity.units, cell(quantity.name));
    }
    compare(path, &document, &with_block(&document, file::SUMMARY, &table));
}
