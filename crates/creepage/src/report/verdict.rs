//! The value of a measure in a sentence.

use crate::check::digits::digits;
use crate::check::measure::Measure;
use crate::check::result::{Metric, Place};

/// A sentence on what was found of a measure.
pub(super) fn verdict(measure: Measure, metric: &Metric) -> String {
    let Some(value) = metric.value else {
        return format!("Not measured: {}.", metric.note.as_deref().unwrap_or("no data"));
    };
    let percent = |value: f64| format!("{} %", digits(100.0 * value, 3));
    let place = metric.place.as_ref().map(place).unwrap_or_default();
    match measure {
        Measure::Penetration => format!(
            "The surfaces penetrate each other by up to {} of the approach of the bodies{place}. A \
             method without penalty springs has no penetration.",
            percent(value)
        ),
        Measure::Tension if value == 0.0 => "No node is under tension.".into(),
        Measure::Tension => format!("Nodes are under tension of up to {} of p0{place}.", percent(value)),
        Measure::Complementarity => format!(
            "The product of gap and pressure reaches {} of approach times p0{place}. It should be zero \
             everywhere, since either the gap or the pressure is zero.",
            percent(value)
        ),
        Measure::Cone if value <= 1e-10 => "No shear exceeds the static bound.".into(),
        Measure::Cone => format!("Shear exceeds the static bound by up to {}{place}.", percent(value)),
        Measure::AdhesionSlip => format!(
            "Nodes with a shear below the bound, which should stick, slip at up to {} times the \
             rigid slip s_c{place}.",
            digits(value, 3)
        ),
        Measure::MuError => format!(
            "The coefficient that the algorithm used differs by at most {} from the one that the law \
             gives for the recorded slip, pressure, place and time.",
            percent(value)
        ),
        Measure::MuErrorUncertain => format!(
            "Where not every step is recorded, the coefficient differs by {} (median) more than the \
             missing steps can explain.",
            percent(value)
        ),
        Measure::LawError => format!(
            "Where nodes slip, the shear differs from the bound \u{3bc}(|s|) p by {} (root mean \
             square). Motion of a node while penalty springs hold it in stick counts as slip.",
            percent(value)
        ),
        Measure::LawErrorSlipState => format!(
            "At nodes that the algorithm lets slip, the shear differs from the bound by {}. This is \
             the error of the friction algorithm, without the deformation of penalty springs in stick.",
            percent(value)
        ),
        Measure::LawErrorOwn => format!(
            "From the bound with the coefficient that the algorithm used, the shear differs by {}. \
             This leaves out the error of a coefficient that lags behind the slip.",
            percent(value)
        ),
        Measure::Direction => format!(
            "Where nodes slip, the shear deviates by {} degrees (root mean square) from the direction \
             opposite to the slip.",
            digits(value, 3)
        ),
        Measure::DirectionSlipState => format!(
            "At nodes that the algorithm lets slip, the shear deviates by {} degrees from the \
             direction opposite to the slip.",
            digits(value, 3)
        ),
        Measure::WrongDirection => {
            format!(
                "On {} of the slipping area and time, the shear drives the slip instead of opposing it.",
                percent(value)
            )
        }
        Measure::MeshMode => format!(
            "{} of the slip alternates from node to node. Above {}, this is a mode of the mesh, or slip \
             that the mesh does not resolve.",
            percent(value),
            percent(contact::mesh_mode::MESH_MODE_LIMIT)
        ),
        Measure::Dissipation => format!(
            "{} of the power exchanged in slip has the wrong sign: friction supplies energy instead of \
             dissipating it.",
            percent(value)
        ),
        Measure::ViolatingFraction => {
            format!("On {} of the contact area and time, the conditions are violated.", percent(value))
        }
        Measure::ViolatingFractionSlipState => format!(
            "At nodes that the algorithm lets slip, the conditions are violated on {} of contact area and time.",
            percent(value)
        ),
        Measure::RoughnessRatio => {
            let meaning = match value {
                v if v < 0.8 => "the traction is too smooth for its slip",
                v if v > 1.25 => "the traction is rougher than the law allows",
                _ => "traction and slip fluctuate as the law demands",
            };
            format!("p_f/p fluctuates {} times as much as \u{3bc}(|s|): {meaning}.", digits(value, 3))
        }
        Measure::LawScatter => {
            "Root mean square distance of the points (|s|, p_f/p) from the graph of the law, with |s| in \
             units of the rigid slip s_c."
                .into()
        }
        Measure::SwitchingRate => {
            "Changes between stick and slip per node, in the time that a shear wave needs to cross an \
             element. Values near 1 mean chatter at the scale of the mesh."
                .into()
        }
    }
}

/// Where and when a measure is worst, at a node.
fn place(place: &Place) -> String {
    let Some([x, y, _]) = place.position.map(|position| position.map(|x| digits(1e3 * x, 3)))
    else {
        return String::new();
    };
    format!(" (worst at x = {x} mm, y = {y} mm, t = {} ms)", digits(1e3 * place.time, 5))
}
