//! Steady rolling in steps of a part of the pitch of the grid of contact points.
//!
//! [`Rolling`] moves the contact by one pitch in a step, so that every step finds it at the same place on the grid. Here the
//! nodes stay with the material for `n` steps while the contact moves over them by a pitch, and only then the grid moves on by
//! one point. A node therefore enters and leaves the contact at the times that its position gives, as it does in a
//! calculation with small time steps.

use crate::reference::rolling::STEADY;
use crate::reference::{Influence, Pressed, Rigid, Rolling, RollingError};

/// Rolling with a constant coefficient of friction, in equal steps that make up one pitch.
pub struct RollingInParts<'a> {
    /// The contact after each step, in the order in which it takes these places.
    places: Vec<Rolling<'a>>,
}

impl<'a> RollingInParts<'a> {
    /// Bodies pressed together at the places on the grid that the contact takes within a pitch: with `n` places, that
    /// of number k has its middle k/n of a pitch further towards +x than the first. The points are the same at all of
    /// them, as by [`Influence::with_gaps`].
    ///
    /// # Errors
    /// As [`Rolling::new`].
    pub fn new(places: &'a [(Influence, Pressed)], mu: f64) -> Result<Self, RollingError> {
        let place =
            |(influence, pressed): &'a (Influence, Pressed)| Rolling::new(influence, pressed, mu);
        Ok(Self { places: places.iter().map(place).collect::<Result<_, _>>()? })
    }

    /// Rolls until the forces are those of a pitch before, at most `pitches`, and returns the number of pitches. `rigid` is
    /// along t1 and t2 and holds for a step; a given motion is the creepage times the pitch over the number of steps.
    ///
    /// # Errors
    /// [`RollingError::Step`], [`RollingError::Unsteady`].
    pub fn steady(&mut self, rigid: [Rigid; 2], pitches: usize) -> Result<usize, RollingError> {
        let n = self.places.len();
        let whole = rigid.map(|motion| match motion {
            Rigid::Moved(by) => Rigid::Moved(by * n as f64),
            forced => forced,
        });
        self.places.iter_mut().for_each(|place| place.guess(whole));
        let mut change = f64::INFINITY;
        for pitch in 1..=pitches {
            let before = self.places[n - 1].force();
            for k in 0..n {
                let (earlier, later) = self.places.split_at_mut(k);
                match (earlier.last(), later) {
                    (Some(last), [next, ..]) => next.go_on(last, false, rigid)?,
                    (None, [next, .., last]) => next.go_on(last, true, rigid)?,
                    (None, [only]) => only.roll(rigid)?,
                    _ => {}
                }
            }
            let last = &self.places[n - 1];
            let largest = last.bound().iter().fold(0.0f64, |m, g| m.max(*g));
            let changes = before.iter().zip(last.force());
            let changes = changes.flat_map(|(a, b)| [(a[0] - b[0]).abs(), (a[1] - b[1]).abs()]);
            change = changes.fold(0.0, f64::max) / largest;
            if change <= STEADY {
                return Ok(pitch);
            }
        }
        Err(RollingError::Unsteady { steps: pitches, change })
    }

    /// The contact at each of its places in the last pitch.
    pub fn places(&self) -> &[Rolling<'a>] {
        &self.places
    }

    /// Creepage of the last pitch (dimensionless): the rigid motion of its steps over the pitch, along t1 and t2.
    pub fn creepage(&self) -> [f64; 2] {
        let sum = |a: usize| self.places.iter().map(|place| place.creepage()[a]).sum();
        [sum(0), sum(1)]
    }
}
