//! The list of problems.

use crate::{
    Problem, carter, cattaneo, collision, contact_examples, contact_turn, corrugation, finite_body,
    free_block, grading_reflection, half_space_rolling, half_space_rupture, half_space_waves,
    hertz, hertz_stress, implicit, interface_patch, kalker, lamb, lysmer, manchester, mindlin,
    patch, perturbation_growth, rolling_dynamic, rolling_limits, rolling_memory, rolling_sideways,
    rolling_steps, rupture, shear_column, shear_column_penalty, slider_tables, sliding,
    steady_rolling, unlike, waves,
};

/// All problems, from the element to rolling contact.
pub const PROBLEMS: &[Problem] = &[
    Problem {
        name: "patch",
        about: "A uniform finite strain of seven distorted elements: exact stress, no residual",
        run: patch::patch,
    },
    Problem {
        name: "rotation",
        about: "A rigid rotation through a full turn: no stress, no force",
        run: patch::rotation,
    },
    Problem {
        name: "free-block",
        about: "A free block of fully integrated elements: five other codes to 7 digits",
        run: free_block::run,
    },
    Problem {
        name: "bar-wave",
        about: "A wave in a slender bar: speed sqrt(E/rho) and stress rho c v",
        run: waves::bar,
    },
    Problem {
        name: "column-wave",
        about: "A wave in a laterally confined column: speed c_p and stress rho c_p v",
        run: waves::column,
    },
    Problem {
        name: "block-slide",
        about: "A block that slides on a plane, stops at v0^2/(2 mu g) and stays",
        run: sliding::stop,
    },
    Problem {
        name: "incline",
        about: "A block on an incline: sticks below the angle of friction, slides above",
        run: sliding::incline,
    },
    Problem {
        name: "colliding-bars",
        about: "Two equal bars colliding: contact time 2L/c, pressure rho c v, energies, momentum",
        run: collision::run,
    },
    Problem {
        name: "block-slide-exact",
        about: "The sliding block with exact contact",
        run: sliding::stop_exact,
    },
    Problem {
        name: "implicit-order",
        about: "Implicit steps: order in time of a wave and of a sliding block, energy of a wave",
        run: implicit::order,
    },
    Problem {
        name: "block-slide-implicit",
        about: "The sliding block with implicit steps ten times as long",
        run: sliding::stop_implicit,
    },
    Problem {
        name: "colliding-bars-implicit",
        about: "The colliding bars with implicit steps four times as long",
        run: collision::run_implicit,
    },
    Problem {
        name: "shear-column-implicit",
        about: "The shear column under falling friction with implicit steps",
        run: shear_column::run_implicit,
    },
    Problem {
        name: "incline-exact",
        about: "The block on an incline with exact contact",
        run: sliding::incline_exact,
    },
    Problem {
        name: "block-slide-mortar",
        about: "The sliding block with mortar rows on a plane of another pitch",
        run: sliding::stop_mortar,
    },
    Problem {
        name: "incline-mortar",
        about: "The block on an incline with mortar rows on a plane of another pitch",
        run: sliding::incline_mortar,
    },
    Problem {
        name: "colliding-bars-exact",
        about: "The colliding bars with exact contact",
        run: collision::run_exact,
    },
    Problem {
        name: "shear-column",
        about: "Falling friction between two half-spaces sheared in one dimension: both jumps",
        run: shear_column::run,
    },
    Problem {
        name: "shear-column-penalty",
        about: "The same by penalty and friction of the step before: what refinement at one k_t tends to",
        run: shear_column_penalty::run,
    },
    Problem {
        name: "perturbation-growth",
        about: "A disturbance of steady sliding under falling friction with memory: how fast it grows",
        run: perturbation_growth::run,
    },
    Problem {
        name: "rupture",
        about: "A fault that ruptures by itself, TPV3: rupture times of the boundary integral solution",
        run: rupture::run,
    },
    Problem {
        name: "contact-turn",
        about: "Bodies that turn in contact: gaps of the circle, friction that turns with its face",
        run: contact_turn::run,
    },
    Problem {
        name: "interface-patch",
        about: "Uniform pressure across meshes that do not match: the pressure of exact contact",
        run: interface_patch::run,
    },
    Problem {
        name: "lysmer",
        about: "A wave that meets a quiet end: what comes back",
        run: lysmer::run,
    },
    Problem {
        name: "grading-reflection",
        about: "Plane waves that run down into elements that grow: what comes back",
        run: grading_reflection::run,
    },
    Problem {
        name: "lamb",
        about: "A load that appears on a half-space: static tail and Rayleigh wave",
        run: lamb::run,
    },
    Problem {
        name: "hertz-sphere",
        about: "A sphere on a flat: the patch of Hertz",
        run: hertz::sphere,
    },
    Problem {
        name: "hertz-wheel",
        about: "The reference wheel on its crown: the patch of Hertz, and the bias of penalty springs",
        run: hertz::wheel,
    },
    Problem {
        name: "hertz-line",
        about: "A cylinder on a flat: the patch of Hertz",
        run: hertz::line,
    },
    Problem {
        name: "hertz-stress",
        about: "The disk pressed on the bar: greatest shear below the patch, and its depth, of Hertz",
        run: hertz_stress::run,
    },
    Problem {
        name: "cattaneo",
        about: "A sphere pressed and shifted: zone of stick and shift of Cattaneo and Mindlin",
        run: cattaneo::run,
    },
    Problem {
        name: "carter",
        about: "A rolling cylinder: creepage and zone of stick of Carter",
        run: carter::run,
    },
    Problem {
        name: "kalker",
        about: "Rolling of a circular contact: Kalker's coefficients C11 and C22",
        run: kalker::circle,
    },
    Problem {
        name: "kalker-ellipse",
        about: "Rolling of the reference ellipse: Kalker's coefficients C11 and C22",
        run: kalker::ellipse,
    },
    Problem {
        name: "steady-rolling",
        about: "The reference wheel rolling steadily: creepage, stick, shear and profiles of CONTACT",
        run: steady_rolling::steady,
    },
    Problem {
        name: "creep-force",
        about: "The reference wheel: eight points of the creep-force curve of CONTACT",
        run: steady_rolling::creep_force,
    },
    Problem {
        name: "rolling-steps",
        about: "Rolling in steps of a pitch, a half, a quarter: creepage of Carter and of CONTACT",
        run: rolling_steps::run,
    },
    Problem {
        name: "rolling-memory",
        about: "The reference wheel: falling friction with memory, T/N of CONTACT",
        run: rolling_memory::run,
    },
    Problem {
        name: "half-space-waves",
        about: "Half-spaces with inertia: single modes, a line impulse (Lamb), a point force (Cerruti)",
        run: half_space_waves::run,
    },
    Problem {
        name: "half-space-rupture",
        about: "The rupture of TPV3 between half-spaces with inertia",
        run: half_space_rupture::run,
    },
    Problem {
        name: "half-space-carter",
        about: "Half-spaces without a mesh, without inertia: Carter's creepage and zone of stick",
        run: half_space_rolling::carter,
    },
    Problem {
        name: "half-space-kalker",
        about: "The same: Kalker's coefficients C11, C22 and C23 of CONTACT",
        run: half_space_rolling::kalker,
    },
    Problem {
        name: "half-space-steady",
        about: "The same: creepage, stick and shear of CONTACT's steady rolling",
        run: half_space_rolling::steady,
    },
    Problem {
        name: "half-space-transient",
        about: "The same: from Cattaneo's shift to steady rolling, CONTACT's creepage on the way",
        run: half_space_rolling::transient,
    },
    Problem {
        name: "half-space-memory",
        about: "The same: falling friction with memory, T/N of CONTACT",
        run: half_space_rolling::memory,
    },
    Problem {
        name: "half-space-examples",
        about: "The same: forces of CONTACT's examples carter2d, tractcurv and fastsim",
        run: contact_examples::run,
    },
    Problem {
        name: "manchester",
        about: "S1002 wheels on UIC 60 rails, case A-2.2 of the Manchester benchmark: contact and forces of CONTACT",
        run: manchester::run,
    },
    Problem {
        name: "corrugation",
        about: "A wheel on a corrugated rail: how far the hub follows it, beside half-spaces",
        run: corrugation::run,
    },
    Problem {
        name: "mindlin",
        about: "A sphere shifted to and fro by a table of creepage: forces, stick and dissipation of a cycle",
        run: mindlin::run,
    },
    Problem {
        name: "finite-body",
        about: "The disk on the bar as meshed beside half-spaces; the approach of finite blocks",
        run: finite_body::run,
    },
    Problem {
        name: "rolling-dynamic",
        about: "Steady rolling by explicit dynamics, penalty bias extrapolated, beside CONTACT",
        run: rolling_dynamic::run,
    },
    Problem {
        name: "rolling-exact",
        about: "Steady rolling by explicit dynamics with exact contact, as it is, beside CONTACT",
        run: rolling_dynamic::run_exact,
    },
    Problem {
        name: "rolling-limits",
        about: "Rolling without friction and in gross sliding: no tangential force, and mu N",
        run: rolling_limits::run,
    },
    Problem {
        name: "rolling-sideways",
        about: "Drift and spin with finite elements beside half-spaces: the lateral force",
        run: rolling_sideways::run,
    },
    Problem {
        name: "unlike-materials",
        about: "Aluminium rolls freely on steel: creepage and stick of Bentall and Johnson",
        run: unlike::run,
    },
    Problem {
        name: "slider-tables",
        about: "The 1-D slider of the paper: Tables 2 and 3 to every printed digit",
        run: slider_tables::run,
    },
];

/// The problem with a name; `None` if there is none.
pub fn find(name: &str) -> Option<&'static Problem> {
    PROBLEMS.iter().find(|problem| problem.name == name)
}
