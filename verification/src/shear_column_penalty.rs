//! The shear column of [`crate::shear_column`] with penalty springs and friction of the step before, as in
//! explicit codes: does it tend to Eq (8) as the mesh and the time step are refined at a fixed k_t?
//!
//! Only in part. In slip the spring has no effect: the speed after the jump and the stress at which slip ends are
//! those of the law. But while a sticking interface is loaded, its spring stretches at the speed
//! `s_e = (d tau/dt)/k_t`. Friction that depends on nodal velocities takes this speed for slip, and the interface
//! transmits `Z s_e` less than a rigid one. So stick ends at
//!
//! `tau = mu(s_e) p + Z s_e`, not at mu_S p,
//!
//! for any mesh and time step; it tends to mu_S p only as k_t goes to infinity.

use crate::body::SHEARED;
use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use crate::shear_column::{
    Interface, LAW, LENGTH, PRESSURE, SCALE, STRAIN, Waves, columns, impedance, least,
    speed_at_1_gpa, strain,
};
use dynamics::Simulation;
use friction::FrictionLaw;

/// LS-DYNA's default for steel elements of 1 mm (N/m^3, both passes), ten and a hundred times as much.
const STIFFNESS: [f64; 3] = [3.5e13, 3.5e14, 3.5e15];
/// The stress over p that arrives rises to `PEAK`, above mu_S, over the share `RISE` of the columns, and holds up
/// to the share `HOLD`.
const PEAK: f64 = 0.502;
const RISE: f64 = 0.15;
const HOLD: f64 = 0.45;
const WAVES: Waves = Waves(&[[0.0, 0.0], [RISE, PEAK], [HOLD, PEAK], [1.0, 0.31]]);
/// Elements of the mesh on which the time step is refined, and by which factor.
const REFINED: (usize, f64) = (400, 16.0);
/// Largest relative error of the stress at which stick ends that passes.
const REQUIRED: f64 = 0.01;
const STEP: &str = "one time step, in which the stress rises";
const LAWS: &str = "tau - Z s = mu(s) p with perfect delay (Ionescu and Paumier 1994)";
const SPRINGS: &str = "mu(s_e) p + Z s_e, s_e = (d tau/dt)/k_t: the spring's give counts as slip";
const FACT: (f64, &str) = (0.0, "a fact, 1 for yes");

/// The results of one mesh.
#[derive(Clone, Copy)]
struct Found {
    /// Stress over p, that of a sticking interface, at the onset of slip and at its end.
    onset: f64,
    end: f64,
    /// Rise of the stress over p in a time step.
    resolved: f64,
    /// Slip speed while the stress is constant (m/s, as at 1 GPa), mean with the weight sin^2.
    speed: f64,
}

pub(crate) fn run(size: Size) -> Outcome {
    let meshes: &[usize] = match size {
        Size::Quick => &[200, 400, 800],
        Size::Full => &[200, 400, 800, 1600],
    };
    let on_meshes =
        |k: f64| meshes.iter().map(|&n| shear(n, k, 1.0)).collect::<Result<Vec<Found>, Cause>>();
    let study = |found: &[Found], of: fn(&Found) -> f64| {
        let size = |&n: &usize| LENGTH / n as f64;
        Convergence::with_known_order(meshes.iter().map(size).zip(found.iter().map(of)), 1.0)
    };
    let spring_row = |k: f64, found: &[Found]| {
        let exact = spring_onset(k);
        let step = found.last().map_or(f64::NAN, |f| f.resolved) / exact;
        Row::converged(stick_ends(k), exact, &study(found, |f| f.onset), (step, STEP), SPRINGS)
            .at_most(REQUIRED)
    };
    let [soft, middle, stiff] = STIFFNESS;
    let found = on_meshes(soft)?;
    let onset = study(&found, |f| f.onset).finest();
    let reached = f64::from(u8::from((onset / LAW.mu_static - 1.0).abs() < 0.01));
    let mut rows = vec![
        Row::converged(
            "k_t 3.5e13: speed after the jump (m/s at 1 GPa and k = 6 s/m)",
            speed_at_1_gpa(PEAK),
            &study(&found, |f| f.speed),
            (strain(PEAK), STRAIN),
            LAWS,
        ),
        Row::converged(
            "k_t 3.5e13: stress over p at which slip ends",
            least(),
            &study(&found, |f| f.end),
            (0.0, ""),
            LAWS,
        ),
        spring_row(soft, &found),
        Row::new("k_t 3.5e13: whether stick ends at mu_S p", [0.0, reached], 1.0, FACT, SPRINGS),
    ];

    let (cells, finer) = REFINED;
    let found = shear(cells, soft, finer)?;
    let values = [spring_onset(soft), found.onset];
    let what =
        "k_t 3.5e13, a sixteenth of the step: stress over p at which stick ends, its own theory";
    rows.push(Row::asked(what, values, REQUIRED, SPRINGS));

    rows.push(spring_row(middle, &on_meshes(middle)?));
    // the stiffest spring rings: its values scatter, and two meshes may agree by chance
    let found = on_meshes(stiff)?;
    let onset = study(&found, |f| f.onset);
    let values = [spring_onset(stiff), onset.finest()];
    rows.push(with_meshes(Row::asked(stick_ends(stiff), values, REQUIRED, SPRINGS), &onset));
    Ok(rows)
}

fn stick_ends(k: f64) -> String {
    format!("k_t {k:.1e}: stress over p at which stick ends, its own theory")
}

fn with_meshes(row: Row, study: &Convergence) -> Row {
    Row { meshes: study.samples().to_vec(), ..row }
}

/// The stress over p at which a spring of stiffness `k` ends stick.
fn spring_onset(k: f64) -> f64 {
    let rise = PEAK * PRESSURE / (RISE * LENGTH / SHEARED.c_s());
    let speed = rise / k;
    LAW.mu(speed) + impedance() * speed / PRESSURE
}

fn shear(cells: usize, k: f64, finer: f64) -> Result<Found, Cause> {
    let c = SHEARED.c_s();
    let setup = columns(cells, Interface::Penalty { k, finer }, WAVES)?;
    let resolved = PEAK / RISE * c * setup.dt / LENGTH;
    let mut simulation = Simulation::new(setup);
    let mut table = match simulation.contact() {
        Some(contact) => contact.nodal_table(0),
        None => return Err("no contact".into()),
    };
    let [mut weights, mut slip] = [0.0; 2];
    let (mut onset, mut end) = (f64::NAN, f64::NAN);
    while simulation.time() < 0.99 * LENGTH / c {
        let report = simulation.step(false);
        if let Some(contact) = simulation.contact() {
            contact.nodal(&mut table);
        }
        let share = c * report.time / LENGTH;
        let slips = table.state.contains(&2);
        if slips && onset.is_nan() {
            onset = WAVES.stress(share);
        }
        if !slips && share > HOLD {
            end = WAVES.stress(share);
            break;
        }
        let phase = (share - RISE) / (HOLD - RISE);
        if (0.0..1.0).contains(&phase) {
            let weight = libm::sin(std::f64::consts::PI * phase).powi(2);
            let velocities = table.slip_velocity.iter().map(|s| s[1]);
            slip += weight * velocities.sum::<f64>() / table.slip_velocity.len() as f64;
            weights += weight;
        }
    }
    let speed = slip.abs() / weights / SCALE;
    Ok(Found { onset, end, resolved, speed })
}
