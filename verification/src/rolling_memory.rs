//! Rolling of the reference wheel on its crown under falling friction with memory, without inertia and without penalty.
//!
//! The coefficient follows Eq. (8) of Vollebregt (2017), mu(s) = mu_D + (mu_S - mu_D) exp(-k s), over a distance of slip d_c:
//! d(mu)/dt = -(max(s, s_0)/d_c) (mu - mu(s)), and moves with the particles ([`crate::reference::SlipLaw`]). CONTACT
//! (Vollebregt; Kalker 1990) solved the same problem on half-spaces by boundary elements, with s_0 = 1 mm/s.
//!
//! Convergence is of first order (carter.rs). The steady state is that which Newton's method finds; rolling
//! from rest, step by step, must end in it where CONTACT's transient does not end in a cycle.

use crate::convergence::Convergence;
use crate::half_space::{
    HalfSpaces, STEPS, WHEEL, WHEEL_EXTENT, WHEEL_SIZES, column, on_meshes, sizes,
};
use crate::half_space_rolling::{MEMORY, MEMORY_SOURCE, SPEED, remembering};
use crate::problem::{Cause, Outcome, Size};
use crate::reference::{Influence, Lateral, Rigid, Rolling, SlipLaw};
use crate::row::Row;
use rayon::prelude::*;
use std::sync::Arc;

/// Distance rolled from rest (m), and the part of it at its end over which the mean is taken.
const ROLLED: f64 = 0.090;
/// See [`ROLLED`].
const MEAN: f64 = 0.020;
/// By how much the mean may differ from the steady state, over it.
const STEADY: f64 = 1e-3;
/// Asked of the extrapolated values.
const ASKED: f64 = 0.01;

pub(crate) fn run(size: Size) -> Outcome {
    let blocks = on_meshes(sizes(size, &WHEEL_SIZES), |h| {
        HalfSpaces::new(&WHEEL, WHEEL.block(h, WHEEL_EXTENT, Lateral::Symmetric))
    })?;
    let rows: Vec<Vec<Row>> = MEMORY
        .par_iter()
        .map(|&[distance, creepage, traction, cycle]| {
            let case = Case { distance, creepage };
            case.rows(size, &blocks, traction, cycle)
        })
        .collect::<Result<_, Cause>>()?;
    Ok(rows.concat())
}

/// A distance of memory (m) and a creepage.
struct Case {
    distance: f64,
    creepage: f64,
}

impl Case {
    fn rows(
        &self,
        size: Size,
        blocks: &[(f64, HalfSpaces<'_>)],
        traction: f64,
        cycle: f64,
    ) -> Outcome {
        let found: Vec<(f64, [f64; 1])> = blocks
            .iter()
            .map(|(h, blocks)| {
                let share = |influence: &Influence, _| Ok([self.steady(blocks, influence)?]);
                Ok((*h, blocks.over_a_pitch(share)?))
            })
            .collect::<Result<_, Cause>>()?;
        let study = Convergence::by_theory(column(&found, 0), 1.0);
        let Self { distance, creepage } = self;
        let what = format!("T/N at creepage {creepage}, memory of {:.0} um", 1e6 * distance);
        let body = WHEEL.body(WHEEL_EXTENT);
        let mut rows = vec![Row::extrapolated(&what, traction, &study, body, MEMORY_SOURCE)];
        if size == Size::Full {
            let values = [traction, study.extrapolated()];
            rows.push(Row::asked(format!("{what}, extrapolated"), values, ASKED, MEMORY_SOURCE));
        }
        let (_, finest) = blocks.last().ok_or("no mesh")?;
        let steady = self.steady(finest, &finest.influence)?;
        let limit = match cycle {
            0.0 => (STEADY, "what is left of the transient"),
            _ => (cycle, "the limit cycle of the reference"),
        };
        let values = [steady, self.step_by_step(finest)?];
        let what = format!("{what}: mean after rolling from rest, beside that of steady rolling");
        rows.push(Row::new(what, values, steady, limit, "steady rolling on the same mesh"));
        Ok(rows)
    }

    fn rolling<'b>(
        &self,
        blocks: &HalfSpaces<'_>,
        influence: &'b Influence,
    ) -> Result<(Rolling<'b>, [Rigid; 2]), Cause> {
        let law = SlipLaw { law: Arc::new(remembering(self.distance)), speed: SPEED };
        let rolling = Rolling::with_law(influence, &blocks.press(influence)?, law)?;
        let rigid = [Rigid::Moved(self.creepage * rolling.pitch()), Rigid::Moved(0.0)];
        Ok((rolling, rigid))
    }

    /// T/N of steady rolling.
    fn steady(&self, blocks: &HalfSpaces<'_>, influence: &Influence) -> Result<f64, Cause> {
        let (mut rolling, rigid) = self.rolling(blocks, influence)?;
        rolling.steady(rigid, STEPS)?;
        Ok(rolling.total()[0] / blocks.load)
    }

    /// T/N of rolling from rest, step by step: its mean over the end of the way.
    fn step_by_step(&self, blocks: &HalfSpaces<'_>) -> Result<f64, Cause> {
        let (mut rolling, rigid) = self.rolling(blocks, &blocks.influence)?;
        let steps = |distance: f64| (distance / rolling.pitch()).round() as usize;
        let (all, last) = (steps(ROLLED), steps(MEAN));
        let mut sum = 0.0;
        for n in 0..all {
            rolling.roll(rigid)?;
            if n + last >= all {
                sum += rolling.total()[0] / blocks.load;
            }
        }
        Ok(sum / last as f64)
    }
}
