//! The figures of a run: the papers' ones and those that show what the papers argue about.

mod caption;
mod half_space;
mod histories;
mod lines;
mod maps;
mod scatter;
mod spectrum;

use crate::PostError;
use crate::basis::{Basis, RunPaths};
use crate::check::Scales;
use crate::frames::{ContactHistory, Frame};
use crate::means::Sources;
use crate::patch_series;
use crate::vector::{Vec3, axpy};
use crate::window::{Span, Window};
use figure::{Figure, colour};
use output::layout::file;
use std::ops::Range;

/// Interval of the papers' snapshots (s).
const SNAPSHOTS: f64 = 5.7e-6;

/// Colours of the three instants.
const INSTANTS: [[u8; 3]; 3] = [colour::BLUE, colour::RED, colour::GREEN];

/// A figure and the name of its files.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name without extension.
    pub stem: &'static str,
    /// What it shows, in a phrase.
    pub about: &'static str,
    /// The figure.
    pub figure: Figure,
}

/// A record that is drawn, with where its patch is.
pub(crate) struct Instant {
    frame: Frame,
    /// x of the patch's centre (m).
    centre: f64,
}

/// Means over the window that figures state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FigureMeans {
    pub normal_force: Option<f64>,
    pub creepage: Option<f64>,
    pub traction_coefficient: Option<f64>,
}

/// What every figure is drawn from.
pub(crate) struct Scene<'a> {
    pub history: &'a ContactHistory,
    pub basis: &'a Basis,
    pub scales: Scales,
    /// The body whose nodes are drawn: the bar where there are two.
    pub body: u8,
    pub records: Range<usize>,
    /// From and to (s).
    pub window: [f64; 2],
    /// Means over the window, as far as the run holds them.
    pub means: FigureMeans,
    pub instants: Vec<Instant>,
}

/// Draws all figures of a run for which it has the data: those of lines and maps at the last
/// record of the window and at two before it, the papers' 5.7 us apart where records allow.
///
/// # Errors
/// A contact history that cannot be read or lacks what figures are made of.
pub fn figures(
    paths: &RunPaths,
    basis: &mut Basis,
    window: Option<Span>,
) -> Result<Vec<Named>, PostError> {
    let history = ContactHistory::open(&paths.contact)?;
    let window = Window::settle(window, basis, &history)?;
    let records = window.records.clone();
    let scales = Scales::settle(basis, &history, &records)?;
    let body = history.surface.bodies().last().copied().unwrap_or(0);
    let sources = Sources::of(paths, basis, &window)?;
    let means = FigureMeans {
        normal_force: sources.mean("normal_force"),
        creepage: sources.mean("creepage"),
        traction_coefficient: sources.mean("traction_coefficient"),
    };
    let window = window.shown(&history.times);
    let instants = Vec::new();
    let mut scene =
        Scene { history: &history, basis, scales, body, records, window, means, instants };
    for index in scene.instant_indices() {
        let frame = history.record(index)?;
        let centre = scene.centre(&frame);
        scene.instants.push(Instant { frame, centre });
    }
    let band = maps::Band::gather(&scene)?;
    let mut all = vec![
        Named {
            stem: "figure-1-velocities",
            about: "velocities of the surface nodes of both bodies along y = 0, and their difference",
            figure: lines::velocities(&scene),
        },
        Named {
            stem: "figure-2-stick-slip",
            about: "where the patch sticks and slips at three instants",
            figure: maps::stick_slip(&scene),
        },
        Named {
            stem: "figure-3-tractions",
            about: "pressure, shear and the bound of friction along y = 0",
            figure: lines::tractions(&scene),
        },
        Named {
            stem: "figure-4-bound",
            about: "the bound that the slip velocity implies, beside the shear",
            figure: lines::bound(&scene),
        },
        Named {
            stem: "figure-7-law",
            about: "shear over pressure against slip speed, over the friction law",
            figure: scatter::law(&scene, &band),
        },
        Named {
            stem: "space-time",
            about: "slip along y = 0 over time",
            figure: maps::space_time(&scene, &band),
        },
    ];
    if let Some(figure) = histories::histories(&scene, &paths.folder.join(file::HISTORY))? {
        let about = "forces, creepage, patch and energies over time";
        all.push(Named { stem: "histories", about, figure });
    }
    if let Some(figure) = spectrum::spectrum(&scene, &paths.folder.join(file::PROBES))? {
        let about = "spectrum of the slip velocity at the probe nodes";
        all.push(Named { stem: "spectrum", about, figure });
    }
    Ok(all)
}

impl Scene<'_> {
    /// The last record and two before it.
    fn instant_indices(&self) -> Vec<usize> {
        let times = &self.history.times;
        let last = self.records.end - 1;
        let mut chosen = vec![last];
        for back in 1..3 {
            let wanted = times[last] - SNAPSHOTS * f64::from(back);
            let before = self.records.start..chosen[0];
            let away = |i: &usize| (times[*i] - wanted).abs();
            if let Some(index) = before.min_by(|a, b| away(a).total_cmp(&away(b))) {
                chosen.insert(0, index);
            }
        }
        chosen
    }

    pub fn centre(&self, frame: &Frame) -> f64 {
        let p0 = self.scales.peak_pressure;
        let row =
            patch_series::measure(&self.history.surface, frame, self.body, p0, self.basis.shape);
        if row.values[2].is_finite() { row.values[2] } else { 0.0 }
    }

    pub fn position(&self, frame: &Frame, row: usize) -> Vec3 {
        let point = self.history.surface.points[row];
        match &frame.motion {
            Some([displacement, _]) => axpy(point, 1.0, displacement[row]),
            None => point,
        }
    }

    /// Rows of a body's nodes nearest y = 0, by their reference x.
    pub fn centreline(&self, body: u8) -> Vec<usize> {
        self.history.surface.centreline(body, self.scales.size)
    }

    /// Half of what is drawn along x (m).
    pub fn reach(&self) -> f64 {
        1.35 * self.basis.scale("half_length").unwrap_or(10.0 * self.scales.size)
    }

    pub fn in_contact(&self, frame: &Frame, row: usize) -> bool {
        frame.pressure[row] > crate::conditions::IN_CONTACT * self.scales.peak_pressure
    }

    fn mu_static(&self) -> f64 {
        self.basis.law.map_or(0.5, |law| law.mu_static())
    }
}

/// A time in the legend.
fn time_label(instant: &Instant) -> String {
    format!("t = {:.4} ms", 1e3 * instant.frame.time)
}
