//! A rolling cylinder: Carter (1926).
//!
//! In plane strain the creepage at q = Q/(mu N) is mu a/R (1 - sqrt(1 - q)), and the zone of
//! stick is the strip of half width a sqrt(1 - q) at the leading edge (Johnson 1985, Sec. 8.3).
//! First order of convergence is that of the method: slip is a difference over one pitch of forces
//! that act at its ends. On a given mesh that is as if the forces acted half a pitch, h/2 of the half length a, off their
//! place: the limit of the creepage on the finest mesh.

use crate::convergence::Convergence;
use crate::half_space::{HalfSpaces, LINE, LINE_EXTENT, LINE_SIZES, column, on_meshes, sizes};
use crate::problem::{Cause, Outcome, Size};
use crate::reference::{Adhesion, Lateral, Rigid, stick_border};
use crate::row::Row;

pub(crate) const MU: f64 = 0.3;
pub(crate) const SOURCE: &str = "Carter (1926)";
/// Q/(mu N) and creepage.
pub(crate) const TABLE: [[f64; 2]; 4] =
    [[0.25, 6.225e-4], [0.5, 1.3609e-3], [0.75, 2.3232e-3], [0.9, 3.1771e-3]];

pub(crate) fn run(size: Size) -> Outcome {
    let mut rows = Vec::new();
    let slices = on_meshes(sizes(size, &LINE_SIZES), |h| {
        HalfSpaces::new(&LINE, LINE.block(h, LINE_EXTENT, Lateral::PlaneStrain))
    })?;
    let a = LINE.half_axes[0];
    for [share, creepage] in TABLE {
        let found: Vec<(f64, [f64; 3])> = slices
            .iter()
            .map(|(h, slice)| Ok((*h, rolled(slice, share)?)))
            .collect::<Result<_, Cause>>()?;
        let creepages = Convergence::by_theory(column(&found, 0), 1.0);
        let quantity = format!("Q/(mu N) = {share}: creepage");
        let body = LINE.body(LINE_EXTENT);
        rows.push(Row::extrapolated(&quantity, creepage, &creepages, body, SOURCE));
        let quantity = format!("{quantity} on the finest mesh");
        let Some((h, [_, at, astray])) = found.last() else { continue };
        let half = (0.5 * h / a, "half a pitch, h/(2a)");
        rows.push(Row::new(quantity, [creepage, creepages.finest()], creepage, half, SOURCE));
        let border = a - 2.0 * a * (1.0 - share).sqrt();
        let row = Row::new(
            format!("Q/(mu N) = {share}: border of stick (m), over a"),
            [border, *at],
            a,
            (0.5 * h / a, "half an element, h/(2a): it lies between two nodes"),
            SOURCE,
        );
        let borders = Convergence::by_theory(column(&found, 1), 1.0);
        rows.push(Row { meshes: borders.samples().to_vec(), ..row });
        rows.push(Row::new(
            format!("Q/(mu N) = {share}: points not in the state of their side of the border"),
            [0.0, *astray],
            1.0,
            (0.0, "a number of points"),
            "one zone of stick, at the leading edge",
        ));
    }
    Ok(rows)
}

/// Creepage, as a mean over a pitch; and with the apex on a node the border of stick (m) and the number of points whose
/// state is not that of their side of the border.
fn rolled(slice: &HalfSpaces<'_>, share: f64) -> Result<[f64; 3], Cause> {
    let force = Rigid::Forced(share * MU * slice.load);
    let [creepage] = slice
        .over_a_pitch(|influence, _| Ok([slice.roll(influence, MU, |_| force)?.creepage()[0]]))?;
    let rolling = slice.roll(&slice.influence, MU, |_| force)?;
    let border = stick_border(&slice.influence, &rolling).ok_or("nothing sticks")?;
    // a point within an element of the end of the patch carries almost no force, and may be in either state
    let inside = LINE.half_axes[0] - 0.999 * slice.size;
    let states = rolling.contact().iter().zip(rolling.adhesion());
    let astray = states.filter(|(i, state)| {
        let x = slice.influence.points()[**i].at[0];
        x.abs() < inside && (*state == Adhesion::Stick) != (x > border - 0.5 * slice.size)
    });
    Ok([creepage, border, astray.count() as f64])
}
