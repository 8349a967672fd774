//! The three-dimensional picture of a run: both bodies, or both contact surfaces, with their deformation magnified.
//!
//! Magnified is what is left of a displacement without the rigid motion of its body, so that every body stays
//! where it is at that time and the dents of disk and bar face each other.

mod error;
mod quantity;
mod rigid;
mod shot;
mod source;

pub use error::RenderError;
pub use quantity::{Drawable, Quantity};

use crate::chart::{Key, Picture, Scale};
use crate::check::PostError;
use crate::check::basis::{may_be_run, read_toml};
use output::layout::file;
use shot::{Bounds, Shot};
use source::Source;
use std::path::Path;
use std::str::FromStr;

/// Which views of the bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// The two below, side by side.
    #[default]
    Both,
    /// Both bodies as a whole.
    Whole,
    /// The contact from near.
    Contact,
}

impl FromStr for View {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "both" => Ok(Self::Both),
            "whole" => Ok(Self::Whole),
            "contact" => Ok(Self::Contact),
            _ => Err("both, whole or contact is needed"),
        }
    }
}

/// What to draw.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted {
    /// What is drawn; `None` for that which `quantity` is of, or the bodies.
    pub what: Option<Drawable>,
    /// What the colours show; `None` for the first that the run has.
    pub quantity: Option<Quantity>,
    /// Views of the bodies.
    pub view: View,
    /// How many times larger than it is deformation is drawn; `None` for a round number that shows it.
    pub magnify: Option<f64>,
    /// Side of what a view of the contact shows (m); `None` for one that shows the patch.
    pub span: Option<f64>,
}

/// A run that is drawn.
pub struct Rendering {
    source: Source,
    quantity: Quantity,
    title: String,
    shots: Vec<Shot>,
    /// Upper end of the colour bar, in the unit of its label.
    top: f64,
}

impl Rendering {
    /// Opens the run in `folder`.
    ///
    /// # Errors
    /// A case in the place of the folder; files that are not there, cannot be read or lack what is to be shown.
    pub fn open(folder: &Path, wanted: &Wanted) -> Result<Self, RenderError> {
        may_be_run(folder)?;
        if !folder.is_dir() {
            let reason = "is a file: give the folder of the run".into();
            return Err(PostError::Text { path: folder.into(), reason }.into());
        }
        let what = wanted.what.or(wanted.quantity.map(Quantity::of)).unwrap_or(Drawable::Fields);
        let source = Source::open(folder, what)?;
        let first = what.quantities().find(|quantity| source.shows(*quantity));
        let quantity = wanted.quantity.or(first).unwrap_or(Quantity::Deformation);
        let case = read_toml(&folder.join(file::CASE))?.unwrap_or_default();
        let title = case.get("title").and_then(|title| title.as_str()).unwrap_or_default().into();
        let shots = shot::shots(&source, what, wanted);
        Ok(Self { source, quantity, title, shots, top: 1.0 })
    }

    /// Times of the records (s).
    pub fn times(&self) -> &[f64] {
        &self.source.times
    }

    /// The record nearest to `time` (s).
    pub fn nearest(&self, time: f64) -> usize {
        let off = |record: &usize| (self.source.times[*record] - time).abs();
        (0..self.source.times.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }

    /// What the colours show.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// Label of the colour bar, and its upper end; the lower is 0.
    pub fn colours(&self) -> (&'static str, f64) {
        (self.quantity.label().0, self.top)
    }

    /// How much larger than it is deformation is drawn, in each view.
    pub fn magnifications(&self) -> Vec<f64> {
        self.shots.iter().map(|shot| shot.magnify).collect()
    }

    /// Fixes colours, magnification and cameras, so that they are the same in the pictures of all `records`.
    ///
    /// # Errors
    /// Records that cannot be read.
    pub fn scale_to(&mut self, records: &[usize]) -> Result<(), RenderError> {
        let mut bounds = Bounds::default();
        for &record in records {
            bounds.take(&self.source, &self.source.record(record, self.quantity)?);
        }
        self.shots.iter_mut().for_each(|shot| shot.scale_to(&bounds));
        self.top = bounds.top();
        Ok(())
    }

    /// The picture of a record, after [`Self::scale_to`].
    ///
    /// # Errors
    /// A record that cannot be read.
    pub fn picture(&self, index: usize) -> Result<Picture, RenderError> {
        let record = self.source.record(index, self.quantity)?;
        let (label, top) = self.colours();
        let key = Key::Values { label: label.into(), range: [0.0, top], scale: Scale::Linear };
        // milliseconds, to a microsecond
        let time = format!("t = {:.3} ms", 1e3 * self.source.times[index]);
        let heading = format!("{time}    {}", self.title);
        let panes = self.shots.iter().map(|shot| shot.pane(&record)).collect();
        Ok(Picture { heading: heading.trim_end().into(), panes, key })
    }
}
