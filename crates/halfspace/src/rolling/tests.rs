use super::*;
use crate::ellipse::Ellipse;
use friction::{Coulomb, Exponential, Implicit, Memory, Remembering};

const LAW: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };

fn setup(width: Option<f64>, law: Arc<dyn NodeFriction>) -> Setup {
    let bodies = HalfSpaces::new(210e9, 0.3, 7850.0);
    let spacing = 1e-3;
    Setup {
        bodies,
        spacing,
        patch: Ellipse { half_length: 6e-3, half_width: width, peak_pressure: 1e9 }.into(),
        offset: 0.0,
        speed: 40.0,
        start: 0.0,
        step: 0.5 * spacing / bodies.pressure_speed,
        inertia: Inertia::Dynamic,
        law,
        pressure_factor: None,
    }
}

fn driven(creepage: f64) -> Rigid {
    Rigid { along: Along::Creepage(creepage), lateral: 0.5 * creepage, spin: 0.0 }
}

#[test]
fn friction_holds_at_every_point_and_spends_what_the_drive_gives() {
    let memory = Memory { distance: 3e-6, floor: 1e-2 };
    let laws: [Arc<dyn NodeFriction>; 3] = [
        Arc::new(Coulomb { mu: 0.4 }),
        Arc::new(Implicit(LAW)),
        Arc::new(Remembering { steady: LAW, memory }),
    ];
    for law in laws {
        for width in [Some(4e-3), None] {
            let mut rolling = Rolling::new(setup(width, Arc::clone(&law))).unwrap();
            let (mut slipped, mut balance, mut driven_by) = (false, 0.0, 0.0);
            for _ in 0..3000 {
                let sums = rolling.step(driven(0.01));
                assert_eq!(sums.unconverged, 0.0);
                balance += sums.driven - sums.stored - sums.dissipated;
                driven_by += sums.driven;
                for p in rolling.patch() {
                    let size = |v: [f64; 2]| libm::hypot(v[0], v[1]);
                    let (tau, bound) = (size(p.shear), p.mu * p.pressure);
                    assert!(tau <= bound * (1.0 + 1e-14), "{p:?}");
                    let power = p.shear[0] * p.slip_velocity[0] + p.shear[1] * p.slip_velocity[1];
                    let full = -tau * size(p.slip_velocity);
                    assert!((power - full).abs() <= 1e-13 * full.abs(), "{p:?}");
                    assert!(p.slips || p.slip_velocity == [0.0; 2]);
                    slipped |= p.slips;
                }
            }
            assert!(slipped && driven_by > 0.0);
            assert!(balance.abs() < 1e-7 * driven_by, "{balance} {driven_by}");
        }
    }
}

#[test]
fn points_that_leave_perfect_delay_are_counted_and_under_constant_friction_none_does() {
    let steep = Exponential { decay: 30.0, ..LAW };
    let laws: [Arc<dyn NodeFriction>; 2] =
        [Arc::new(Coulomb { mu: 0.4 }), Arc::new(Implicit(steep))];
    let [constant, falling] = laws.map(|law| {
        // steps so long that points are coupled closely
        let base = setup(Some(4e-3), law);
        let mut rolling = Rolling::new(Setup { step: 4.0 * base.step, ..base }).unwrap();
        let steps = (0..5).map(|_| rolling.step(driven(0.01)));
        steps.filter(|sums| sums.undelayed > 0).collect::<Vec<_>>()
    });
    assert!(constant.is_empty(), "{constant:?}");
    assert!(!falling.is_empty());
    for sums in falling {
        assert!(sums.unconverged == 0.0 && sums.iterations > 30, "{sums:?}");
        assert!(sums.undelayed <= sums.non_unique.min(sums.slipping), "{sums:?}");
    }
}

/// Line contact in steps of one spacing, where each slip moves the whole patch: CONTACT's example `veldep_fric`.
fn quasi_static_falling() -> Rolling {
    let law = Exponential { mu_static: 0.3, mu_dynamic: 0.18, decay: 6.93 };
    let patch = Ellipse { half_length: 4e-3, half_width: None, peak_pressure: 495.3e6 }.into();
    let (spacing, speed) = (0.4e-3, 45.0);
    Rolling::new(Setup {
        bodies: HalfSpaces::new(209.92e9, 0.28, 7850.0),
        spacing,
        patch,
        speed,
        step: 0.999 * spacing / speed,
        inertia: Inertia::Static,
        ..setup(None, Arc::new(Implicit(law)))
    })
    .unwrap()
}

#[test]
fn without_inertia_falling_friction_of_the_same_instant_holds_at_every_step() {
    // the force is 0.45 of what friction bears at rest
    let creepage = |_| Along::Creepage(1e-3);
    let force = |step| Along::Force(0.45 * 0.3 * 3.11e6 * f64::min(f64::from(step) / 40.0, 1.0));
    for (along, least) in [(&creepage as &dyn Fn(i32) -> Along, 10), (&force, 5)] {
        let mut rolling = quasi_static_falling();
        let (mut together, mut iterations) = (0, 0);
        for step in 1..=60 {
            let sums = rolling.step(Rigid { along: along(step), lateral: 0.0, spin: 0.0 });
            assert_eq!(sums.unconverged, 0.0, "{sums:?}");
            for p in rolling.patch() {
                let s = p.slip_velocity[0].abs();
                let mu = 0.18 + 0.12 * libm::exp(-6.93 * s);
                assert!((p.mu - mu).abs() <= 1e-12, "{p:?}");
                let excess = p.shear[0].abs() - mu * p.pressure;
                let off = if p.slips { excess.abs() } else { excess.max(0.0) };
                assert!(off <= 2e-9 * 0.3 * 495.3e6, "{p:?}");
            }
            together = together.max(sums.slipping);
            iterations = iterations.max(sums.iterations);
        }
        // of the 21 points many let go at once, and coefficients had to be iterated
        assert!(together >= least && iterations > 2000, "{together} {iterations}");
    }
}

#[test]
fn a_patch_goes_on_from_its_state_with_the_same_bits() {
    let law = Arc::new(Remembering { steady: LAW, memory: Memory { distance: 1e-6, floor: 1e-2 } });
    let mut whole = Rolling::new(setup(Some(4e-3), law.clone())).unwrap();
    let mut parted = Rolling::new(setup(Some(4e-3), law.clone())).unwrap();
    for _ in 0..700 {
        whole.step(driven(0.01));
        parted.step(driven(0.01));
    }
    let state = parted.snapshot();
    let mut parted = Rolling::new(setup(Some(4e-3), law)).unwrap();
    parted.restore(&state).unwrap();
    for _ in 0..700 {
        assert_eq!(whole.step(driven(0.01)), parted.step(driven(0.01)));
    }
    assert!(whole.patch().eq(parted.patch()));
    let mut other = Rolling::new(setup(None, Arc::new(Coulomb { mu: 0.4 }))).unwrap();
    assert_eq!(other.restore(&state), Err(RollingError::State));
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let sums = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut rolling =
                Rolling::new(setup(Some(4e-3), Arc::new(Coulomb { mu: 0.4 }))).unwrap();
            (0..400).map(|_| rolling.step(driven(0.01))).next_back().unwrap()
        })
    };
    assert_eq!(sums(1), sums(3));
}

#[test]
fn a_force_is_met_at_every_step() {
    let mut rolling = Rolling::new(setup(Some(4e-3), Arc::new(Coulomb { mu: 0.4 }))).unwrap();
    for n in 1..=500 {
        let force = 2.0 * f64::from(n);
        let rigid = Rigid { along: Along::Force(force), lateral: 0.0, spin: 0.0 };
        let sums = rolling.step(rigid);
        assert!((sums.shear[0] / force - 1.0).abs() < 1e-7, "{sums:?}");
    }
}

#[test]
fn a_shift_in_one_step_gives_the_force_of_mindlin_and_of_many_steps() {
    let (a, mu, poisson, share) = (6e-3, 0.3, 0.3, 0.7);
    let force = |steps: i32| {
        let base = setup(Some(a), Arc::new(Coulomb { mu }));
        let load = 2.0 / 3.0 * std::f64::consts::PI * a * a * base.patch.peak_pressure();
        let rigidity = 8.0 * base.bodies.shear_modulus * a / (3.0 * mu * load * (2.0 - poisson));
        // Mindlin (1949): Johnson 1985, Eq. (7.42)
        let shift = (1.0 - f64::powf(1.0 - share, 2.0 / 3.0)) / rigidity;
        let (speed, step) = (1e-6, 1e-6);
        let creepage = shift / (f64::from(steps) * speed * step);
        let setup = Setup { spacing: 0.5e-3, speed, step, inertia: Inertia::Static, ..base };
        let mut rolling = Rolling::new(setup).unwrap();
        let rigid = Rigid { along: Along::Creepage(creepage), lateral: 0.0, spin: 0.0 };
        let sums = (0..steps).map(|_| rolling.step(rigid)).last().unwrap();
        assert_eq!(sums.unconverged, 0.0);
        sums.shear[0] / sums.normal
    };
    let [one, many] = [1, 20].map(force);
    assert!((one / (share * mu) - 1.0).abs() < 0.02, "{one}");
    assert!((one / many - 1.0).abs() < 1e-3, "{one} {many}");
}

#[test]
fn a_patch_of_few_points_is_refused() {
    let coarse = Setup { spacing: 4e-3, ..setup(Some(4e-3), Arc::new(Coulomb { mu: 0.4 })) };
    assert!(matches!(Rolling::new(coarse), Err(RollingError::Coarse { .. })));
}
