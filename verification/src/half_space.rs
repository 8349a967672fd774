//! Half-spaces as finite bodies: the blocks of the static problems, and Hertz contacts on them.
//!
//! A body on its own mirror image represents two equal half-spaces ([`crate::reference::Block`]). A block that ends at L
//! changes the field that the traction of a patch of half axis a causes at that distance: this is of order (a/L)^3 in
//! the strain over the patch, (a/L)^2 in plane strain.

use crate::body::STEEL;
use crate::problem::{Cause, Size};
use crate::reference::{
    Block, Influence, Lateral, Press, Pressed, Rigid, Rolling, RollingInParts, ellipsoid, press,
};
use nalgebra::Vector3;
use rayon::prelude::*;
use solid::{Element, Material, element_stiffness};

/// Stiffness of an element, with the hourglass coefficient of rolling runs.
pub(crate) fn element(x: &[Vector3<f64>; 8], m: &Material) -> [[f64; 24]; 24] {
    element_stiffness(x, m, Element { hourglass: 0.05 })
}

/// Two paraboloids in contact (Hertz 1882; Johnson 1985, "Contact mechanics", Ch. 4).
pub(crate) struct Hertz {
    /// Radii of relative curvature along x and y (m).
    pub(crate) radii: [f64; 2],
    /// Half axes of the patch (m).
    pub(crate) half_axes: [f64; 2],
    /// Largest pressure (Pa).
    pub(crate) p0: f64,
    /// Load (N); of a line contact N/m.
    pub(crate) load: f64,
    /// The element size (m) at which elements grow by the factor 1.7 outside the fine zone. Finer meshes are graded
    /// more gently, so that all meshes are similar.
    coarse: f64,
}

/// A sphere of R = 0.1 m on a flat.
pub(crate) const SPHERE: Hertz = Hertz {
    radii: [0.1; 2],
    half_axes: [1.8663e-3; 2],
    p0: 1.3709e9,
    load: 1e4,
    coarse: 1.8663e-3 / 4.0,
};

/// The reference wheel on its crown.
pub(crate) const WHEEL: Hertz = Hertz {
    radii: [0.46, 0.30],
    half_axes: [7.1617e-3, 5.3872e-3],
    p0: 1.2376e9,
    load: 1e5,
    coarse: 1.4e-3,
};

/// A cylinder on a flat.
pub(crate) const LINE: Hertz = Hertz {
    radii: [0.46, f64::INFINITY],
    half_axes: [7.125e-3, 0.0],
    p0: 0.8936e9,
    load: 1e7,
    coarse: 1e-3,
};

impl Hertz {
    /// A contact whose half axes (m) are given, under `load` (N; of a line contact, without a second half axis, N/m), for
    /// half-spaces without elements.
    pub(crate) fn of_patch(half_axes: [f64; 2], load: f64) -> Self {
        let [a, b] = half_axes;
        let part = if b > 0.0 { 1.5 / b } else { 2.0 };
        let p0 = part * load / (std::f64::consts::PI * a);
        Self { radii: [f64::NAN; 2], half_axes, p0, load, coarse: f64::NAN }
    }

    /// The block for this contact, with elements of `size` (m) around the patch and half extent `extent` (m).
    pub(crate) fn block(&self, size: f64, extent: f64, lateral: Lateral) -> Block {
        let [a, b] = self.half_axes;
        Block {
            size,
            reach: [1.3 * a, 1.3 * b],
            depth: if b > 0.0 { b } else { a },
            extent,
            growth: libm::pow(1.7f64, size / self.coarse),
            lateral,
            material: STEEL,
        }
    }

    /// The relative change that a block ending at `extent` (m) may cause in the patch, and its name.
    pub(crate) fn body(&self, extent: f64) -> (f64, &'static str) {
        let [a, b] = self.half_axes;
        if b > 0.0 {
            ((a / extent).powi(3), "the finite block, (a/L)^3")
        } else {
            ((a / extent).powi(2), "the finite slice, (a/L)^2")
        }
    }
}

/// Two equal blocks, or the parts of them that a plane of symmetry or plane strain leaves.
pub(crate) struct HalfSpaces<'a> {
    hertz: &'a Hertz,
    pub(crate) influence: Influence,
    lateral: Lateral,
    /// Size of the elements (m).
    pub(crate) size: f64,
    /// The load on those parts (N).
    pub(crate) load: f64,
}

impl<'a> HalfSpaces<'a> {
    pub(crate) fn new(hertz: &'a Hertz, block: Block) -> Result<Self, Cause> {
        let share = match block.lateral {
            Lateral::Full => 1.0,
            Lateral::Symmetric => 0.5,
            Lateral::PlaneStrain => block.size,
        };
        let influence = block.influence(&element, gap(hertz, block.lateral, [0.0; 2]))?;
        let (lateral, size, load) = (block.lateral, block.size, share * hertz.load);
        Ok(Self { hertz, influence, lateral, size, load })
    }

    /// Means of the quantities of `measure`, which gets the influence matrix and the x of the apex (m), with the apex
    /// at four places within one cell of the grid. Which nodes lie inside the patch depends on its place on the grid;
    /// on coarse grids this changes results by a few per cent, which is not a matter of convergence.
    pub(crate) fn over_a_pitch<const N: usize>(
        &self,
        measure: impl Fn(&Influence, f64) -> Result<[f64; N], Cause> + Sync,
    ) -> Result<[f64; N], Cause> {
        // one in each row and each column of a 4 x 4 subdivision of the cell
        let places = [[-0.375, -0.125], [-0.125, 0.375], [0.125, -0.375], [0.375, 0.125]];
        let found: Vec<[f64; N]> = places
            .par_iter()
            .map(|place| {
                let apex = place.map(|s| s * self.size);
                measure(&self.influence.with_gaps(gap(self.hertz, self.lateral, apex)), apex[0])
            })
            .collect::<Result<_, _>>()?;
        Ok(std::array::from_fn(|k| found.iter().map(|f| f[k]).sum::<f64>() / found.len() as f64))
    }

    pub(crate) fn press(&self, influence: &Influence) -> Result<Pressed, Cause> {
        Ok(press(influence, Press::Load(self.load), None)?)
    }

    /// Largest pressure (Pa), half axes (m) and approach (m).
    pub(crate) fn patch(&self, influence: &Influence) -> Result<[f64; 4], Cause> {
        let pressed = self.press(influence)?;
        let fit = ellipsoid(influence, &pressed).ok_or("the pressures show no ellipsoid")?;
        Ok([fit.p0, fit.a, fit.b, pressed.approach])
    }

    /// Steady rolling along x; `along` maps the pitch (m) to the force (N), or to the motion over a pitch (m).
    pub(crate) fn roll<'b>(
        &self,
        influence: &'b Influence,
        mu: f64,
        along: impl Fn(f64) -> Rigid,
    ) -> Result<Rolling<'b>, Cause> {
        let mut rolling = Rolling::new(influence, &self.press(influence)?, mu)?;
        let rigid = [along(rolling.pitch()), Rigid::Moved(0.0)];
        rolling.steady(rigid, STEPS)?;
        Ok(rolling)
    }

    /// Creepage of steady rolling along x under `force` (N) in steps of a part of the pitch, 1, 2 or 4 of them to a pitch.
    /// With fewer than 4 it is the mean of as many rollings as bring the apex to the same four places on the grid.
    pub(crate) fn creepage_in_parts(
        &self,
        parts: usize,
        mu: f64,
        force: f64,
    ) -> Result<f64, Cause> {
        let starts = 4 / parts;
        let rolled = |start: usize| -> Result<f64, Cause> {
            let place = |part: usize| {
                let apex = ((part * starts + start) as f64 + 0.5) / 4.0 - 0.5;
                let gap = gap(self.hertz, self.lateral, [apex * self.size, 0.0]);
                let influence = self.influence.with_gaps(gap);
                let pressed = self.press(&influence)?;
                Ok((influence, pressed))
            };
            let places: Vec<_> = (0..parts).map(place).collect::<Result<_, Cause>>()?;
            let mut rolling = RollingInParts::new(&places, mu)?;
            rolling.steady([Rigid::Forced(force), Rigid::Moved(0.0)], STEPS)?;
            Ok(rolling.creepage()[0])
        };
        let sum: f64 = (0..starts).map(rolled).sum::<Result<_, Cause>>()?;
        Ok(sum / starts as f64)
    }
}

/// Pitches after which rolling must be steady.
pub(crate) const STEPS: usize = 3000;

/// Gap of paraboloids with their apex at x and y (m); on a plane of symmetry the apex stays.
fn gap(hertz: &Hertz, lateral: Lateral, apex: [f64; 2]) -> impl Fn(f64, f64) -> f64 {
    let [rx, ry] = hertz.radii;
    let across = if lateral == Lateral::Full { apex[1] } else { 0.0 };
    move |x, y| (x - apex[0]).powi(2) / (2.0 * rx) + (y - across).powi(2) / (2.0 * ry)
}

/// The result of `solve` on meshes of each size (m).
pub(crate) fn on_meshes<T: Send>(
    sizes: &[f64],
    solve: impl Fn(f64) -> Result<T, Cause> + Sync,
) -> Result<Vec<(f64, T)>, Cause> {
    sizes.par_iter().map(|&h| Ok((h, solve(h)?))).collect()
}

/// The k-th of several quantities, with the mesh size (m).
pub(crate) fn column<const N: usize>(
    found: &[(f64, [f64; N])],
    k: usize,
) -> impl Iterator<Item = (f64, f64)> + '_ {
    found.iter().map(move |(h, values)| (*h, values[k]))
}

/// The first three of the element sizes for [`Size::Quick`], all for [`Size::Full`].
pub(crate) fn sizes(size: Size, all: &[f64]) -> &[f64] {
    match size {
        Size::Quick => &all[..all.len().min(3)],
        Size::Full => all,
    }
}

/// Element sizes for the sphere (m).
pub(crate) const SPHERE_SIZES: [f64; 4] =
    [1.8663e-3 / 4.0, 1.8663e-3 / 5.6, 1.8663e-3 / 7.84, 1.8663e-3 / 10.976];
/// Element sizes for the wheel (m).
pub(crate) const WHEEL_SIZES: [f64; 4] = [1.4e-3, 1e-3, 0.714e-3, 0.5e-3];
/// Element sizes for the line (m).
pub(crate) const LINE_SIZES: [f64; 4] = [1e-3, 0.5e-3, 0.25e-3, 0.125e-3];
/// Half extents of the blocks (m).
pub(crate) const SPHERE_EXTENT: f64 = 0.02;
pub(crate) const WHEEL_EXTENT: f64 = 0.08;
pub(crate) const LINE_EXTENT: f64 = 0.15;
