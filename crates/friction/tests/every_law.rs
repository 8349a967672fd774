//! What every friction law keeps. A new law is tested by one line in [`laws!`] below.
#![allow(clippy::unwrap_used)]

use friction::{
    Declaration, Expression, FrictionLaw as _, Kind, LAWS, LeftOut, Mode, NUMBERS, NodeConditions,
    NodeFriction, NodeHistory, Number, OTHERS, Parameters, Remembers, all_parameters, slip_speed,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

/// A law by the parameters that a case file would give it.
struct Law {
    parameters: Parameters,
}

impl Law {
    fn read(text: &str) -> Self {
        let mut parameters: Parameters = toml::from_str(text).unwrap();
        let exact = parameters.mode == Some(Mode::Exact);
        parameters.write_defaults(exact);
        Self { parameters }
    }

    fn made(&self) -> Box<dyn NodeFriction> {
        self.parameters.node_friction(Expression::untried, None).unwrap()
    }

    /// The same law where the unit of length is the millimetre.
    fn in_millimetres(&self) -> Box<dyn NodeFriction> {
        let mut p = self.parameters.clone();
        for (number, value) in self.parameters.numbers.given() {
            match number.unit {
                "m" | "m/s" => p.numbers.set(number, value * 1e3),
                "s/m" => p.numbers.set(number, value / 1e3),
                unit => assert!(unit == "-" || unit == "s", "{unit}"),
            }
        }
        p.table.iter_mut().flatten().for_each(|[speed, _]| *speed *= 1e3);
        p.expression.iter_mut().for_each(|text| *text = text.replace('s', "(s/1000)"));
        p.memory.iter_mut().for_each(|memory| {
            memory.distance *= 1e3;
            memory.floor *= 1e3;
        });
        p.node_friction(Expression::untried, None).unwrap()
    }
}

/// Slip speeds (m/s) and durations (s) of a node's history, and a pressure (Pa).
fn histories() -> impl Strategy<Value = (Vec<(f64, f64)>, f64)> {
    let speed = prop_oneof![Just(0.0), (-9.0..2.0f64).prop_map(|e| 10f64.powf(e))];
    let duration = (-8.0..-4.0f64).prop_map(|e| 10f64.powf(e));
    (prop::collection::vec((speed, duration), 1..20), 1e6..2e9)
}

fn at(pressure: f64) -> NodeConditions {
    NodeConditions { position: [0.01, 0.0, 0.0], time: 1e-3, pressure }
}

/// The states that a node comes through.
fn states(law: &dyn NodeFriction, history: &[(f64, f64)], at: &NodeConditions) -> Vec<[f64; 2]> {
    let mut state = law.begin(at);
    let mut all = vec![state];
    for &(speed, duration) in history {
        state = law.advance(state, speed, at, duration);
        all.push(state);
    }
    all
}

fn for_histories(test: impl Fn(&[(f64, f64)], &NodeConditions)) {
    let mut runner = TestRunner::new(Config::with_cases(64));
    let tried = runner.run(&histories(), |(history, pressure)| {
        test(&history, &at(pressure));
        Ok(())
    });
    tried.unwrap();
}

fn gives_a_coefficient(law: &Law) {
    let law = law.made();
    for_histories(|history, at| {
        for state in states(&*law, history, at) {
            for speed in [0.0, 1e-9, 1e-3, 1.0, 1e3] {
                let mu = law.mu(state, speed, at);
                assert!(mu.is_finite() && mu >= 0.0, "{mu} at {speed} m/s");
            }
        }
    });
}

fn is_continuous_in_the_slip_speed(law: &Law) {
    let law = law.made();
    for_histories(|history, at| {
        for state in states(&*law, history, at) {
            for &(speed, _) in history {
                let jump = law.mu(state, speed * (1.0 + 1e-9), at) - law.mu(state, speed, at);
                assert!(jump.abs() < 1e-7, "{jump:e} at {speed} m/s");
            }
        }
    });
}

fn depends_on_the_same_instant_only_as_it_says_and_by_its_slope(law: &Law) {
    let law = law.made();
    for_histories(|history, at| {
        for state in states(&*law, history, at) {
            for &(speed, _) in history.iter().filter(|(speed, _)| *speed > 0.0) {
                let step = 1e-5 * speed;
                let [low, high] = [speed - step, speed + step].map(|s| law.mu(state, s, at));
                let slope = law.slope(state, speed, at);
                if law.is_implicit() {
                    let difference = (high - low) / (2.0 * step);
                    let off = (slope - difference).abs() * speed;
                    assert!(off < 1e-5, "{slope} {difference} at {speed} m/s");
                } else {
                    assert_eq!((low.to_bits(), slope), (high.to_bits(), 0.0));
                }
            }
        }
    });
}

fn has_the_same_state_over_any_division_of_a_step(law: &Law) {
    let law = law.made();
    for_histories(|history, at| {
        for (state, &(speed, duration)) in states(&*law, history, at).into_iter().zip(history) {
            let whole = law.advance(state, speed, at, duration);
            for parts in [2, 7, 100] {
                let part = duration / f64::from(parts);
                let by_parts = (0..parts).fold(state, |s, _| law.advance(s, speed, at, part));
                for (a, b) in whole.into_iter().zip(by_parts) {
                    assert!((a - b).abs() <= 1e-12 * a.abs(), "{whole:?} {by_parts:?} {parts}");
                }
            }
        }
    });
}

/// No more than it says, and no less: a history before the last step counts only for a law that remembers
/// contact, and there it counts.
fn keeps_what_it_says_it_remembers(law: &Law) {
    let law = law.made();
    let counted = std::cell::Cell::new(0);
    for_histories(|history, now| {
        let (&(speed, duration), earlier) = history.split_last().unwrap();
        // contact that began under half the pressure
        let before = *states(&*law, earlier, &at(0.5 * now.pressure)).last().unwrap();
        let last = law.advance(before, speed, now, duration);
        let fresh = law.advance(law.begin(now), speed, now, duration);
        match law.remembers() {
            Remembers::Nothing => assert_eq!((last, fresh), (before, before)),
            Remembers::LastStep => assert_eq!(last, fresh),
            Remembers::Contact => counted.set(counted.get() + u32::from(last != fresh)),
        }
    });
    let remembers = law.remembers() == Remembers::Contact;
    assert_eq!(counted.get() > 0, remembers, "histories that count: {}", counted.get());
}

fn has_the_same_bits_for_one_node_and_for_all_at_once(law: &Law) {
    let law = law.made();
    for_histories(|history, at| {
        let all = states(&*law, history, at);
        let nodes = all.iter().zip(history);
        let mut nodes: Vec<NodeHistory> = nodes
            .map(|(&state, &(slip_speed, _))| NodeHistory { state, slip_speed, at: *at })
            .collect();
        let one_by_one: Vec<_> =
            nodes.iter().map(|n| law.advance(n.state, n.slip_speed, at, 1e-7)).collect();
        law.advance_all(&mut nodes, 1e-7);
        assert!(nodes.iter().map(|n| n.state).eq(one_by_one));
    });
}

/// At the solution of a node's tangential problem friction opposes slip, takes from the slip velocity what
/// the bound allows and no more, and never hands energy back.
fn dissipates_and_keeps_the_bound_where_a_node_slips(law: &Law) {
    let law = law.made();
    for_histories(|history, at| {
        for state in states(&*law, history, at) {
            let curve = |s: f64| (law.mu(state, s, at), law.slope(state, s, at));
            for &(free, _) in history {
                for (c, slipped) in [(1e-3, false), (1e-3, true), (0.5, false), (0.5, true)] {
                    match slip_speed::solve(free, c, slipped, &curve) {
                        None => assert!(c * curve(0.0).0 >= free, "it sticks though it cannot"),
                        Some((speed, mu)) => {
                            assert!((0.0..=free).contains(&speed), "{speed} of {free}");
                            assert_eq!(mu, curve(speed).0);
                            let off = (speed + c * mu - free).abs();
                            assert!(off <= 1e-11 * (free + c * mu), "{off:e} of {free}");
                        }
                    }
                }
            }
        }
    });
}

fn gives_the_same_coefficients_in_other_units(law: &Law) {
    let [si, mm] = [law.made(), law.in_millimetres()];
    for_histories(|history, at| {
        let faster: Vec<_> = history.iter().map(|&(speed, dt)| (1e3 * speed, dt)).collect();
        let [a, b] = [states(&*si, history, at), states(&*mm, &faster, at)];
        for (a, b) in a.into_iter().zip(b) {
            for speed in [0.0, 1e-6, 0.1, 5.0] {
                let (a, b) = (si.mu(a, speed, at), mm.mu(b, 1e3 * speed, at));
                assert!((a - b).abs() <= 1e-9 * a.abs(), "{a} {b} at {speed} m/s");
            }
        }
    });
}

/// Laws without state, all of which fall here.
fn falls_from_the_coefficient_at_rest_by_its_slope(law: &Law) {
    let Some(law) = law.parameters.steady(Expression::untried).transpose().unwrap() else {
        return;
    };
    assert_eq!((law.mu(0.0), law.strengthens()), (law.mu_static(), None));
    let by_difference = (law.mu(0.0) - law.mu(1e-7)) / 1e-7;
    assert!((law.fall_at_rest() - by_difference).abs() < 1e-5, "{by_difference}");
    if let Some(same) = law.as_exponential() {
        let least = same.mu_dynamic;
        assert!((0.0..=same.mu_static).contains(&least) && same.decay >= 0.0, "{same:?}");
        for_histories(|history, _| {
            for &(speed, _) in history {
                let (mu, slope) = (law.mu(speed), law.slope(speed));
                assert!((mu - same.mu(speed)).abs() < 1e-15, "{mu} at {speed} m/s");
                assert!((slope - same.slope(speed)).abs() < 1e-15 * (1.0 + slope.abs()));
                assert!((least..=law.mu_static()).contains(&mu), "{mu} at {speed} m/s");
            }
        });
    }
}

macro_rules! every_law_keeps {
    ($text:expr; $($rule:ident)*) => {
        use super::*;
        $(#[test]
        fn $rule() {
            super::$rule(&Law::read($text));
        })*
    };
}

/// One module of tests per law: its name and the parameters of a case file.
macro_rules! laws {
    ($($name:ident: $text:expr;)*) => {
        $(mod $name {
            every_law_keeps! { $text;
                gives_a_coefficient
                is_continuous_in_the_slip_speed
                depends_on_the_same_instant_only_as_it_says_and_by_its_slope
                has_the_same_state_over_any_division_of_a_step
                keeps_what_it_says_it_remembers
                has_the_same_bits_for_one_node_and_for_all_at_once
                dissipates_and_keeps_the_bound_where_a_node_slips
                gives_the_same_coefficients_in_other_units
                falls_from_the_coefficient_at_rest_by_its_slope
            }
        })*
    };
}

laws! {
    coulomb: "static = 0.3";
    exponential_lagged: "law = 'exponential'\nstatic = 0.5";
    exponential_at_the_same_instant: "law = 'exponential'\nstatic = 0.5\nmode = 'exact'";
    exponential_with_memory: "law = 'exponential'\nstatic = 0.5\nmemory.distance = 1e-5";
    polach_lagged: "law = 'polach'\nstatic = 0.55\nratio = 0.4\ndecay = 0.6";
    polach_at_the_same_instant:
        "law = 'polach'\nstatic = 0.55\nratio = 0.4\ndecay = 0.6\nmode = 'exact'";
    slip_weakening: "law = 'slip_weakening'\nstatic = 0.5\ndistance = 1e-5";
    rate_state_ageing: "law = 'rate_state'\ndistance = 1e-5\nmode = 'exact'";
    rate_state_slip: "law = 'rate_state'\nstate = 'slip'\ndistance = 1e-5\nmode = 'exact'";
    rate_state_lagged: "law = 'rate_state'\ndistance = 1e-5";
    prakash_clifton: "law = 'prakash_clifton'\nstatic = 0.4\ndistance = 1e-5";
    table: "law = 'table'\ntable = [[0, 0.4], [0.5, 0.3], [2, 0.25]]";
    table_at_the_same_instant: "law = 'table'\nmode = 'exact'\ntable = [[0, 0.4], [2, 0.2]]";
    formula: "law = 'expression'\nexpression = '0.2 + 0.2/(1 + s)'";
    formula_with_memory: "law = 'expression'\nexpression = '0.2 + 0.2/(1 + s)'\nmemory.distance = 1e-6";
}

#[test]
fn every_law_of_a_case_file_has_its_line() {
    let lines = include_str!("every_law.rs");
    for word in LAWS.map(|law| law.word).into_iter().filter(|word| *word != "python") {
        let named = format!("law = '{word}'");
        assert!(word == "coulomb" || lines.contains(&named), "{word}");
    }
}

#[test]
fn every_law_has_its_word_and_parameters_that_exist_in_their_ranges() {
    for kind in Kind::ALL {
        let law = kind.declaration();
        let read: Parameters = toml::from_str(&format!("law = '{}'", law.word)).unwrap();
        assert_eq!(read.law, kind);
        assert_eq!(Declaration::of(law.word).unwrap().word, law.word);
        for key in law.needs.iter().chain(law.takes) {
            assert!(OTHERS.contains(key), "{key}");
        }
        for (number, left_out) in law.numbers {
            assert_eq!(
                Number::of(number.key()),
                Some(number),
                "two declarations of {}",
                number.path
            );
            let [low, high] = number.range;
            if let LeftOut::Default(value) = left_out {
                assert!((low..=high).contains(value), "{}", number.path);
            }
        }
    }
}

#[test]
fn the_documents_name_the_keys_of_every_law() {
    let text = include_str!("../../../docs/method.md");
    for law in LAWS {
        let row = text.lines().find(|line| line.starts_with(&format!("| `\"{}\"` |", law.word)));
        let row = row.unwrap_or_else(|| panic!("docs/method.md has no row for {}", law.word));
        let keys = row.rsplit('|').nth(1).unwrap();
        let named = all_parameters().filter(|key| keys.contains(&format!("`{key}`")));
        let mut wanted: Vec<_> = law.keys().collect();
        wanted.sort_by_key(|key| all_parameters().position(|other| other == *key));
        assert_eq!(named.collect::<Vec<_>>(), wanted, "docs/method.md: {row}");
    }
}

#[test]
fn a_number_that_is_left_out_has_its_default() {
    for law in Kind::ALL {
        let parameters = Parameters { law, ..Parameters::default() };
        for (number, left_out) in law.declaration().numbers {
            let expected = match left_out {
                LeftOut::Refused => 0.0,
                LeftOut::Default(value) => *value,
                LeftOut::Follows { of, .. } => of(&parameters),
            };
            assert_eq!(parameters.value(*number), expected, "{} of {law:?}", number.path);
        }
    }
}

#[test]
fn every_case_gives_the_numbers_that_the_default_law_needs_and_no_others() {
    let needed = NUMBERS.iter().filter(|number| number.is_needed_by_default());
    let of_default: Vec<_> = Parameters::default().declaration().needs().collect();
    assert_eq!(needed.map(Number::key).collect::<Vec<_>>(), of_default);
}

#[test]
fn the_schema_names_every_law_with_its_coefficient_and_every_parameter() {
    let schema = schemars::schema_for!(Parameters).to_value();
    let properties = schema["properties"].as_object().unwrap();
    for key in all_parameters() {
        assert!(properties[key]["description"].is_string(), "{key}");
    }
    let said = properties["law"]["description"].as_str().unwrap();
    for law in LAWS {
        assert!(said.contains(&format!("`\"{}\"`", law.word)), "{} in {said}", law.word);
        assert!(said.contains(law.coefficient), "{} in {said}", law.coefficient);
    }
}
