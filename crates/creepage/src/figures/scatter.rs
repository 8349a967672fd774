//! The analogue of the paper's Figure 7: all nodes of the window over the friction law.

use super::caption::caption;
use super::maps::Band;
use super::scene::Scene;
use crate::chart::{Axis, Draw, Figure, Panel, Series, colour};

/// p_f/p_n against |s| of every node in contact in the window, over the graph of the law.
pub(super) fn law(scene: &Scene<'_>, band: &Band) -> Figure {
    let fastest = band.points.iter().map(|p| p[0]).fold(1e-3, f64::max);
    let mut series = vec![Series {
        label: "nodes in contact".into(),
        points: band.points.clone(),
        draw: Draw::Dots(colour::BLUE, 1.0),
    }];
    if let Some(law) = scene.basis.law {
        let falling = (0..=400).map(|i| fastest * f64::from(i) / 400.0).map(|s| [s, law.mu(s)]);
        let graph = std::iter::once([0.0, 0.0]).chain(falling);
        series.push(Series {
            label: "the law: |s| = 0 up to \u{3bc}_{S}, then \u{3bc}(|s|)".into(),
            points: graph.collect(),
            draw: Draw::Line(colour::VERMILION),
        });
    }
    let panel = Panel {
        series,
        ..Panel::new(
            Axis::linear("|s| (m/s)").over(-0.02 * fastest, 1.02 * fastest),
            Axis::linear("p_{f}/p_{n} (-)").over(0.0, 1.1 * scene.mu_static()),
        )
    };
    let text = "Shear over pressure against the slip speed of the same record, every node in \
                contact in the window, over the friction law (as the paper's Figure 7). Points \
                off the vermilion line violate the contact conditions.";
    Figure { size: [760, 500], columns: 1, panels: vec![panel], caption: caption(scene, text) }
}
