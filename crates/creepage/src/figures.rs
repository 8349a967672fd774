//! The figures of a run: those of the papers, and further ones over space and time.

mod caption;
mod half_space;
mod histories;
mod lines;
mod maps;
mod patch;
mod reference;
mod scatter;
mod scene;
pub mod slider;
mod spectrum;
mod subsurface;

use crate::chart::Figure;
use crate::check::PostError;
use crate::check::Scales;
use crate::check::basis::{Basis, RunPaths};
use crate::check::frames::ContactHistory;
use crate::check::means::Sources;
use crate::check::patch_series::PatchMeasure;
use crate::check::window::{Span, Window};
use crate::subsurface::Below;
use output::layout::file;

pub use reference::Reference;
pub(crate) use scene::{FigureMeans, Instant, Scene};

/// A figure with the name of its files.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name without extension.
    pub stem: &'static str,
    /// What it shows, in a phrase.
    pub about: &'static str,
    /// The figure.
    pub figure: Figure,
}

/// Which instants and probes are drawn, and beside what.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Times of lines and maps (s); the last of the window where there are none.
    pub instants: Vec<f64>,
    /// Numbers of the probes; the first ones where there are none.
    pub probes: Vec<usize>,
    /// What the tractions are drawn beside, where it is to be computed.
    pub reference: Option<Reference>,
}

/// All figures of a run for which it has the data. Lines and maps are drawn at the last record of the window and
/// at two before it, 5.7 us apart (as in the papers) where records allow, or at the instants of `choice`. `basis` gets scales found in the
/// records; `window` as in [`Criteria`](crate::check::Criteria).
///
/// # Errors
/// Files that cannot be read or lack data or scales that the figures need; a window without a record; an instant, a probe or a
/// reference that the run does not have.
pub fn figures(
    paths: &RunPaths,
    basis: &mut Basis,
    window: Option<Span>,
    choice: &Choice,
) -> Result<Vec<Named>, PostError> {
    let history = ContactHistory::open(&paths.contact)?;
    let scene = scene(&history, paths, basis, window, &choice.instants)?;
    let mut all = lines_and_law(&scene, paths, choice.reference)?;
    if let Some(figure) = patch::maps(&scene) {
        let about =
            "maps of the patch at an instant: tractions, slip velocity, stick and slip, friction";
        all.push(Named { stem: "contact-maps", about, figure });
    }
    if let Some(below) = Below::read(paths, &history, scene.basis, &scene.scales)? {
        all.push(Named {
            stem: "stress-section",
            about: "von Mises stress of both bodies at y = 0",
            figure: subsurface::section(&scene, &below),
        });
        all.push(Named {
            stem: "stress-depth",
            about: "stress over the depth below the patch, beside half-spaces",
            figure: subsurface::depth(&scene, &below),
        });
    }
    if let Some(figure) = histories::histories(&scene, &paths.folder.join(file::HISTORY))? {
        let about = "forces, creepage, patch and energies over time";
        all.push(Named { stem: "histories", about, figure });
    }
    if let Some(figure) =
        spectrum::spectrum(&scene, &paths.folder.join(file::PROBES), &choice.probes)?
    {
        let about = "spectrum of the slip velocity at the probe nodes";
        all.push(Named { stem: "spectrum", about, figure });
    }
    Ok(all)
}

/// What the figures of a run are drawn from.
fn scene<'a>(
    history: &'a ContactHistory,
    paths: &RunPaths,
    basis: &'a mut Basis,
    window: Option<Span>,
    instants: &[f64],
) -> Result<Scene<'a>, PostError> {
    let window = Window::resolve(window, basis, history)?;
    let records = window.records.clone();
    let scales = Scales::resolve(basis, history, &records)?;
    let sources = Sources::of(paths, basis, &window)?;
    let means = FigureMeans {
        normal_force: sources.mean(PatchMeasure::NormalForce),
        creepage: sources.mean(PatchMeasure::Creepage),
        traction_coefficient: sources.mean(PatchMeasure::TractionCoefficient),
    };
    let mut scene = Scene {
        history,
        basis,
        scales,
        body: history.surface.bodies().last().copied().unwrap_or(0),
        records,
        window: window.ends(&history.times),
        means,
        instants: Vec::new(),
        halves: history.surface.halves(),
        line_reach: 0.0,
    };
    for index in scene.instant_indices(instants)? {
        let frame = history.record(index)?;
        let centre = scene.centre(&frame);
        scene.instants.push(Instant { frame, centre });
    }
    scene.line_reach = scene.reach_of_lines();
    Ok(scene)
}

/// The figures that every run has: those of the papers, and slip over time.
fn lines_and_law(
    scene: &Scene<'_>,
    paths: &RunPaths,
    reference: Option<Reference>,
) -> Result<Vec<Named>, PostError> {
    let computed =
        reference.map(|Reference::HalfSpace| reference::steady(scene, paths)).transpose()?;
    let band = maps::Band::gather(scene)?;
    let named = |stem, about, figure| Named { stem, about, figure };
    Ok(vec![
        named(
            "figure-1-velocities",
            "velocities of the surface nodes along y = 0, and the slip velocity",
            lines::velocities(scene),
        ),
        named(
            "figure-2-stick-slip",
            "where and how fast the patch slips, at up to three instants",
            maps::stick_slip(scene),
        ),
        named(
            "figure-3-tractions",
            "pressure, shear and the bound of friction along y = 0",
            lines::tractions(scene, computed),
        ),
        named(
            "figure-4-bound",
            "the bound that the slip velocity implies, beside the shear",
            lines::bound(scene),
        ),
        named(
            "figure-7-law",
            "shear over pressure against slip speed, over the friction law",
            scatter::law(scene, &band),
        ),
        named("space-time", "slip along y = 0 over time", maps::space_time(scene, &band)),
    ])
}
