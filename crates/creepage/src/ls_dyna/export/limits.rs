//! What keyword files cannot say of a case, and what they say only nearly.

use super::{RollingMotion, by_torque};
use crate::case::schema::{
    Case, ContactLayers, Ends, Enforcement, Normals, PreloadMethod, Stiffness, Volumetric,
};
use friction::{Kind, Mode};

/// What of a case keyword files cannot say, one entry each with the key; nothing where the case can be exported.
pub fn unsayable(case: &Case) -> Vec<String> {
    let (drive, mesh) = (&case.drive, &case.mesh);
    let law = case.friction.law != Kind::Coulomb && case.friction.exponential().is_none();
    let found = [
        (case.is_half_space(), "model: half-spaces have no mesh"),
        (
            case.contact.enforcement != Enforcement::Penalty,
            "contact.enforcement: their contact is penalty, with friction of the step before",
        ),
        (
            matches!(case.contact.penalty.normal, Stiffness::Stability(_)),
            "contact.penalty.normal: springs as a fraction of the stability limit; give a number or { stiffness = N/m^3 }",
        ),
        (
            law,
            "friction.law: their friction has FS, FD and DC, \"coulomb\", \"exponential\" and \"polach\" alone",
        ),
        (case.friction.memory.is_some(), "friction.memory: their friction has none"),
        (
            case.friction.mode == Some(Mode::Exact),
            "friction.mode: their friction is that of the slip velocity of the step before",
        ),
        (
            case.bar.surface.is_some() || case.disk.out_of_round.is_some(),
            "bar.surface, disk.out_of_round: heights that the mesh does not have",
        ),
        (mesh.window.is_some(), "mesh.window: a mesh that moves along"),
        (drive.spin != 0.0, "drive.spin: a hub that turns about two axes"),
        (
            case.preload.method == PreloadMethod::None,
            "preload.method = \"none\": the deck presses the disk down to the depth of the static preload",
        ),
        (
            case.preload.disturbance.is_some(),
            "preload.disturbance: it is applied to the preload's result",
        ),
    ];
    let said = found.into_iter().filter(|(cannot, _)| *cannot);
    said.map(|(_, why)| why.to_owned()).collect()
}

/// What a deck says in another way than the case, one sentence each.
pub(super) fn nearly(rolling: &RollingMotion<'_>) -> Vec<String> {
    let (case, model) = (rolling.case, rolling.model);
    let penalty = &case.contact.penalty;
    let full = case.element.contact_layers == ContactLayers::Full;
    let whole_law = case.element.volumetric == Some(Volumetric::Full);
    let stiffness = format!(
        "contact.penalty.normal = {:?}: SFS makes springs as stiff between cubes of the fine zone",
        penalty.normal
    );
    let step = format!(
        "the time step, {:.4e} s here, is TSSFAC times what the other program takes for stable",
        case.duration() / rolling.facts.steps as f64
    );
    let radius = format!(
        "the creepage is that about the effective rolling radius, {:.9} m: the angular velocity of the curve",
        rolling.facts.radius.effective
    );
    [
        (true, "the preload: the disk stands while it is pressed down, with damping that ends with it".to_owned()),
        (true, step),
        (
            true,
            "the hub: its inertia is that of its nodes about the axle; the counterweight is left out".to_owned(),
        ),
        (!by_torque(case), radius),
        (case.contact.curvature, "contact.curvature: contact meets the facets".to_owned()),
        (
            case.contact.normals == Normals::Averaged,
            "contact.normals: contact meets each facet along its own".to_owned(),
        ),
        (
            penalty.damping != 0.0,
            "contact.penalty.damping: VDC is a share of critical by the other program's masses".to_owned(),
        ),
        (matches!(penalty.normal, Stiffness::Areal(_)), stiffness),
        (
            penalty.tangential != penalty.normal,
            format!(
                "contact.penalty.tangential = {:?}: the friction springs are as stiff as the normal ones",
                penalty.tangential
            ),
        ),
        (
            case.bar.ends == Ends::Quiet,
            "bar.ends: non-reflecting segments; their share of the preload is the other program's".to_owned(),
        ),
        (
            full,
            "element.contact_layers: fully integrated elements are parts 3 and 4, ELFORM 2".to_owned(),
        ),
        (full && whole_law, "element.volumetric: ELFORM 2 takes its own".to_owned()),
        (!model.paired.is_empty(), "mesh.plane_strain: the two sides of the slice are not tied".to_owned()),
        (
            by_torque(case),
            "drive.torque: the angular velocity is prescribed until the disk rolls".to_owned(),
        ),
        (
            !case.output.probes.bar.is_empty() || !case.output.probes.disk.is_empty() || !case.output.window.is_empty(),
            "output.probes, output.window: all nodes of both fine zones are recorded, at one interval".to_owned(),
        ),
    ]
    .into_iter()
    .filter_map(|(holds, what)| holds.then_some(what))
    .collect()
}
