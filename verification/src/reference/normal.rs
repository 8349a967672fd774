//! Frictionless contact of bodies condensed to their surface, by an active set.

use crate::reference::Influence;
use faer::Mat;
use faer::linalg::solvers::Solve;
use thiserror::Error;

/// Changes of the active set at most; about ten are usual.
const ROUNDS: usize = 100;

/// How the bodies are pressed together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Press {
    /// Rigid approach of the slave along -z (m).
    Approach(f64),
    /// Sum of the nodal forces along z (N), positive.
    Load(f64),
}

/// Why bodies cannot be pressed together.
#[derive(Debug, Error, PartialEq)]
pub enum PressError {
    /// The bodies do not touch.
    #[error("the bodies do not touch: the least gap is {gap} m")]
    Open {
        /// Least gap at the given approach (m).
        gap: f64,
    },
    /// The load is not a finite number above zero.
    #[error("a load of {load} N does not press")]
    Load {
        /// The load (N).
        load: f64,
    },
    /// The active set keeps changing.
    #[error("the contact area did not settle in {rounds} changes; {changing} points still change")]
    Unsettled {
        /// Changes made.
        rounds: usize,
        /// Points that changed in the last one.
        changing: usize,
    },
}

/// Two bodies pressed together. The lists have one entry per point of [`Influence::points`], except `contact`.
#[derive(Clone, Debug)]
pub struct Pressed {
    /// Rigid approach of the slave along -z (m).
    pub approach: f64,
    /// Normal force on each point (N), not negative.
    pub force: Vec<f64>,
    /// Gap at each point (m): zero in contact, up to round-off.
    pub gap: Vec<f64>,
    /// The points in contact, ascending indices.
    pub contact: Vec<usize>,
    /// Active sets tried.
    pub rounds: usize,
}

impl Pressed {
    /// Sum of the normal forces (N), each along its own normal.
    pub fn load(&self) -> f64 {
        self.force.iter().sum()
    }

    /// Pressure at each point (Pa): force over area. `influence` is the one that was pressed.
    pub fn pressure(&self, influence: &Influence) -> Vec<f64> {
        self.force.iter().zip(influence.points()).map(|(f, p)| f / p.area).collect()
    }
}

/// Presses the bodies together without friction:
/// gap = g_0 - d c + W_nn f >= 0, f >= 0, gap f = 0 at every point (Signorini), with the undeformed gap g_0 (m), the
/// approach d (m), the component c of the normal along z, the normal forces f (N) and their influence matrix W_nn
/// (m/N).
///
/// `shear` is a tangential force on the points (N, by point, then t1, t2). Its effect on the
/// gap is included where the influence matrix couples the two directions.
///
/// The active set is that of the semismooth Newton method (Hintermüller, Ito and Kunisch 2002):
/// the points with W_ii f > gap. When it no longer changes, complementarity is exact. Whether the contact reaches the
/// border of the potential contact area is not checked.
///
/// # Errors
/// [`PressError`]: no contact, a load that does not press, or an active set that keeps changing.
///
/// # Panics
/// If `shear` is shorter than two entries per point and the directions are coupled.
pub fn press(
    influence: &Influence,
    by: Press,
    shear: Option<&[f64]>,
) -> Result<Pressed, PressError> {
    let n = influence.points.len();
    let mut open: Vec<f64> = influence.points.iter().map(|p| p.gap).collect();
    if let (Some(shear), Some(coupling)) = (shear, &influence.coupling) {
        for i in 0..n {
            // W_nt is the transpose of W_tn.
            open[i] += (0..2 * n).map(|k| coupling[(k, i)] * shear[k]).sum::<f64>();
        }
    }
    let least = open.iter().fold(f64::INFINITY, |m, g| m.min(*g));
    let (mut approach, mut contact): (f64, Vec<usize>) = match by {
        Press::Approach(d) => {
            let touching = |i: &usize| open[*i] < d * influence.closing[*i];
            (d, (0..n).filter(touching).collect())
        }
        Press::Load(load) => {
            let pressing = load > 0.0 && load.is_finite();
            if !pressing {
                return Err(PressError::Load { load });
            }
            // The first guess: the quarter of the points with the least gaps.
            let mut nearest: Vec<usize> = (0..n).collect();
            nearest.sort_by(|&a, &b| open[a].total_cmp(&open[b]).then(a.cmp(&b)));
            nearest.truncate(n.div_ceil(4));
            nearest.sort_unstable();
            (0.0, nearest)
        }
    };
    let mut changing = 0;
    for round in 1..=ROUNDS {
        if contact.is_empty() {
            return Err(PressError::Open { gap: least - approach });
        }
        let force = match by {
            Press::Approach(_) => active_forces(influence, &open, &contact, Some(approach)).0,
            Press::Load(load) => {
                let (force, d) = balanced(influence, &open, &contact, load);
                approach = d;
                force
            }
        };
        let mut all = vec![0.0; n];
        for (&i, f) in contact.iter().zip(&force) {
            all[i] = *f;
        }
        let gap: Vec<f64> = (0..n)
            .map(|i| {
                let pushed: f64 =
                    contact.iter().zip(&force).map(|(&j, f)| influence.normal[(i, j)] * f).sum();
                open[i] - approach * influence.closing[i] + pushed
            })
            .collect();
        // The gap of a point of the set is zero, and the force of any other: the sign of the other of the two decides.
        let mut in_set = vec![false; n];
        contact.iter().for_each(|&i| in_set[i] = true);
        let next: Vec<usize> =
            (0..n).filter(|&i| if in_set[i] { all[i] > 0.0 } else { gap[i] < 0.0 }).collect();
        if next == contact {
            return Ok(Pressed { approach, force: all, gap, contact, rounds: round });
        }
        changing = (0..n).filter(|&i| in_set[i] != next.binary_search(&i).is_ok()).count();
        contact = next;
    }
    Err(PressError::Unsettled { rounds: ROUNDS, changing })
}

/// Forces on the contact points for a given approach, or (without one) the pair of the forces per
/// unit approach and those of the gaps alone.
fn active_forces(
    influence: &Influence,
    open: &[f64],
    contact: &[usize],
    approach: Option<f64>,
) -> (Vec<f64>, Vec<f64>) {
    let m = contact.len();
    let matrix = Mat::from_fn(m, m, |i, j| influence.normal[(contact[i], contact[j])]);
    let right = Mat::from_fn(m, 2, |i, k| {
        let i = contact[i];
        match (k, approach) {
            (0, Some(d)) => d * influence.closing[i] - open[i],
            (0, None) => influence.closing[i],
            _ => open[i],
        }
    });
    // W_nn is positive definite; if round-off prevents a Cholesky factor, LU still solves.
    let solution = match matrix.llt(faer::Side::Lower) {
        Ok(llt) => llt.solve(&right),
        Err(_) => matrix.partial_piv_lu().solve(&right),
    };
    let column = |k: usize| (0..m).map(|i| solution[(i, k)]).collect();
    (column(0), column(1))
}

/// Forces on the contact points and the approach at which their sum along z is `load`.
fn balanced(influence: &Influence, open: &[f64], contact: &[usize], load: f64) -> (Vec<f64>, f64) {
    let (per_approach, of_gaps) = active_forces(influence, open, contact, None);
    let along_z =
        |f: &[f64]| -> f64 { f.iter().zip(contact).map(|(f, &i)| f * influence.closing[i]).sum() };
    let approach = (load + along_z(&of_gaps)) / along_z(&per_approach);
    let force = per_approach.iter().zip(&of_gaps).map(|(a, b)| a * approach - b).collect();
    (force, approach)
}
