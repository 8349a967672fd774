//! The dimensionless numbers of a case, before it rolls: what to expect of its friction law. Their definitions:
//! docs/theory.md.

use crate::case::friction_law;
use crate::case::hertz::hertz;
use crate::case::schema::{Case, Creepage, DriveMode, Enforcement};
use crate::scenario::model::{BAR, DISK, Model};
use contact::Stiffness;
use friction::{Falling, Interface};
use halfspace::{Fading, LineRolling};
use output::summary::Numbers;
use solid::Material;

/// The numbers at Hertz's peak pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct DimensionlessNumbers {
    at: Interface,
    /// `N_1 = dt^2 k_t/m*` (dimensionless) of the friction springs of penalty contact.
    n1: Option<f64>,
    /// The numbers of falling friction; none for a law that does not fall.
    falling: Option<Falling>,
    /// Length of the zone of slip (m) by Carter's theory; at most the length of the patch.
    slip_length: f64,
    /// Distance of the law's memory (m).
    memory: Option<f64>,
    /// Nucleation length (m) of friction with memory.
    pub(crate) nucleation: Option<f64>,
    /// Distance of memory (m) from which steady rolling is stable.
    stable_memory: Option<f64>,
}

/// The numbers of a case at Hertz's largest pressure, with the time step `dt` (s).
pub fn numbers(case: &Case, model: &Model, dt: f64) -> DimensionlessNumbers {
    let [disk, bar] = [&model.materials[DISK], &model.materials[BAR]];
    let depth = case.mesh.zone.size;
    let impedance = |m: &Material| m.density * m.c_s();
    // the compliance (1 - nu)/G of mode II, both bodies
    let compliance = |m: &Material| (1.0 - m.poisson) / m.shear();
    let surface = |m: &Material| 0.5 * m.density * depth;
    let in_series = |a: f64, b: f64| a * b / (a + b);
    let at = Interface {
        pressure: hertz(case).p0,
        impedance: in_series(impedance(disk), impedance(bar)),
        modulus: 2.0 / (compliance(disk) + compliance(bar)),
        surface_mass: in_series(surface(disk), surface(bar)),
        dt,
    };
    let mu = friction_law::law(case, model.law.as_ref()).map_or(f64::NAN, |law| law.mu_static());
    let n1 = tangential(case, model, depth).map(|k| friction::spring_number(k, &at));
    DimensionlessNumbers { n1, ..DimensionlessNumbers::of(case, at, mu) }
}

/// Areal stiffness of the friction springs of both passes (N/m^3) between cubes of the size `depth`,
/// if there are any.
fn tangential(case: &Case, model: &Model, depth: f64) -> Option<f64> {
    if case.contact.enforcement == Enforcement::Exact {
        return None;
    }
    match case.contact.penalty.tangential {
        Stiffness::Factor(factor) => {
            Some([DISK, BAR].iter().map(|&b| factor * model.materials[b].bulk() / depth).sum())
        }
        Stiffness::Areal(both) => Some(both),
        // a fraction of 4 m*/dt^2 less the part of the bodies' own frequency, which is not known here
        Stiffness::Stability(_) => None,
    }
}

/// The shear modulus of both bodies against slip in the direction of the creepages, over that of mode II: 1 along rolling,
/// 1 - nu across it for equal bodies (mode III), and between them that whose compliance is `cos^2 + sin^2/(1 - nu)`.
fn directed_modulus(case: &Case, along: f64) -> f64 {
    let [one, other] = [case.disk_material(), case.bar_material()].map(|m| {
        let compliance = 2.0 * (1.0 + m.poisson) / m.young;
        [(1.0 - m.poisson) * compliance, compliance]
    });
    let across = (one[0] + other[0]) / (one[1] + other[1]);
    let lateral = case.drive.lateral_creepage;
    match libm::hypot(along, lateral) {
        0.0 => 1.0,
        size => 1.0 / ((along / size).powi(2) + (lateral / size).powi(2) / across),
    }
}

/// Share of the patch's length that slips in steady rolling by Carter's theory (1926):
/// `|xi| R/(mu_S a)` for a creepage xi along rolling, `1 - sqrt(1 - T/(mu_S N))` for a force T. In another
/// direction the first is multiplied by `directed_modulus`, which is given beside it.
fn slipping(case: &Case, mu: f64, half_length: f64) -> [f64; 2] {
    let (share, directed) = match case.drive.mode {
        DriveMode::Creepage => {
            let along = case.drive.creepage.as_ref().map_or(0.0, Creepage::largest);
            let directed = directed_modulus(case, along);
            let creepage = libm::hypot(along, case.drive.lateral_creepage);
            (creepage * directed * case.disk.radius / (mu * half_length), directed)
        }
        DriveMode::Torque => {
            let force = case.drive.torque.unwrap_or(0.0).abs() / case.disk.radius;
            (1.0 - (1.0 - force / (mu * case.load.normal)).max(0.0).sqrt(), 1.0)
        }
    };
    [share.min(1.0), directed]
}

impl DimensionlessNumbers {
    /// Those of a case without friction springs, `at` its interface, whose coefficient of friction at rest is `mu`.
    pub(crate) fn of(case: &Case, at: Interface, mu: f64) -> Self {
        let falls = case.friction.exponential().filter(|law| friction::falling(law, &at).is_some());
        let of_state = case.friction.rate_state();
        let memory = case.friction.memory.map(|memory| memory.distance);
        let fading = falls.map(Fading::Falling).or(of_state.map(Fading::RateState));
        let half_length = hertz(case).a;
        let [share, directed] = slipping(case, mu, half_length);
        let slip_length = 2.0 * half_length * share;
        let at = Interface { modulus: directed * at.modulus, ..at };
        let rolling = LineRolling {
            modulus: at.modulus,
            half_length,
            pressure: at.pressure,
            slip_length,
            speed: case.drive.speed,
        };
        Self {
            n1: None,
            memory: memory.or(of_state.map(|law| law.distance)),
            stable_memory: fading.and_then(|law| rolling.stable_memory(&law)),
            falling: falls.and_then(|law| friction::falling(&law, &at)),
            nucleation: falls.zip(memory).map(|(law, d)| friction::nucleation_length(&law, d, &at)),
            slip_length,
            at,
        }
    }

    /// The line of the log; none for a law that does not fall.
    pub fn line(&self) -> Option<String> {
        let Some(f) = self.falling else {
            let um = three(1e6 * self.stable_memory?);
            return Some(format!("rate and state: rolling is stable from a distance of {um} um"));
        };
        let mut line = format!("falling friction at {} MPa", three(self.at.pressure * 1e-6));
        for (name, value) in [("R", Some(f.r)), ("N1", self.n1), ("N2", Some(f.n2))] {
            // half-spaces have no surface layer, and without inertia no impedance
            if let Some(value) = value.filter(|value| value.is_finite()) {
                line += &format!(", {name} {}", three(value));
            }
        }
        if let (Some(least), Some(s_m), Some(jump)) = (f.f_min, f.s_m, f.s_jump) {
            line += &format!(
                ", f_min/p {least:.4}, s_m {} m/s, jump to {} m/s",
                three(s_m),
                three(jump)
            );
        }
        if let (Some(length), Some(gamma)) = (self.nucleation, self.gamma()) {
            line += &format!(", h_n {} mm, Gamma {}", three(1e3 * length), three(gamma));
        }
        if let Some(distance) = self.stable_memory {
            line += &format!(", stable from a memory of {} um", three(1e6 * distance));
        }
        Some(line)
    }

    /// `Gamma = l_slip/h_n` of friction with memory.
    fn gamma(&self) -> Option<f64> {
        self.nucleation.map(|length| self.slip_length / length)
    }

    /// One sentence on what to expect of the run, where there is reason for a warning.
    pub fn expectation(&self) -> Option<String> {
        let stable = self.stable_memory.map(|distance| three(1e6 * distance));
        let (key, resolved) = match self.nucleation {
            Some(_) => ("friction.memory.distance", "h_n"),
            None => ("friction.distance", "the zone that becomes unstable"),
        };
        match (self.memory, self.stable_memory, self.falling) {
            (Some(memory), Some(least), _) if memory < least => Some(format!(
                "{key} = {memory:.1e} is below the {} um from which rolling in line contact is stable: slip \
                 may fluctuate by itself, and a mesh has the answer where it resolves {resolved}",
                three(1e6 * least)
            )),
            (None, _, Some(f)) if f.r > 1.0 => Some(format!(
                "R = {} is above 1: friction that falls with the slip speed of the instant has no solution that \
                 meshes converge to; expect slip that jumps between rest and {:.1} m/s, or an artefact in its \
                 place ([friction.memory] gives a solution{})",
                three(f.r),
                f.s_jump.unwrap_or(0.0),
                stable
                    .map_or(String::new(), |um| format!(", steady from a distance of {um} um on"))
            )),
            _ => None,
        }
    }

    /// As the summary has them.
    pub fn result(&self) -> Numbers {
        let f = self.falling;
        Numbers {
            pressure: Some(self.at.pressure),
            impedance: Some(self.at.impedance),
            r: f.map(|f| f.r),
            n1: self.n1,
            n2: f.map(|f| f.n2),
            f_min: f.and_then(|f| f.f_min),
            s_m: f.and_then(|f| f.s_m),
            s_jump: f.and_then(|f| f.s_jump),
            slip_length: Some(self.slip_length),
            nucleation_length: self.nucleation,
            gamma: self.gamma(),
            stable_memory: self.stable_memory,
            expect: self.expectation(),
        }
    }
}

/// A number with three significant digits and no exponent.
pub(crate) fn three(x: f64) -> String {
    let after = (2.0 - libm::log10(x.abs()).floor()).clamp(0.0, 9.0);
    format!("{x:.0$}", after as usize)
}
