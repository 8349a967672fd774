//! Operators of a formula, with the same bits on every machine.

use exmex::{BinOp, FloatOpsFactory, MakeOperators, Operator};

/// The default operators of exmex. Functions that the standard library takes from the system's C library, which
/// rounds differently on other systems, come from `libm` instead.
#[derive(Clone, Debug)]
pub(super) struct Operators;

impl MakeOperators<f64> for Operators {
    fn make<'a>() -> Vec<Operator<'a, f64>> {
        let replaced = |operator: Operator<'a, f64>| {
            let name = operator.repr();
            match (unary(name), binary(name), operator.bin()) {
                (Some(function), ..) => Operator::make_unary(name, function),
                (_, Some(apply), Ok(standard)) => {
                    Operator::make_bin(name, BinOp { apply, ..standard })
                }
                _ => operator,
            }
        };
        FloatOpsFactory::make().into_iter().map(replaced).collect()
    }
}

fn binary(name: &str) -> Option<fn(f64, f64) -> f64> {
    match name {
        "^" => Some(libm::pow),
        "atan2" => Some(libm::atan2),
        _ => None,
    }
}

fn unary(name: &str) -> Option<fn(f64) -> f64> {
    Some(match name {
        "sin" => libm::sin,
        "cos" => libm::cos,
        "tan" => libm::tan,
        "asin" => libm::asin,
        "acos" => libm::acos,
        "atan" => libm::atan,
        "sinh" => libm::sinh,
        "cosh" => libm::cosh,
        "tanh" => libm::tanh,
        "asinh" => libm::asinh,
        "acosh" => libm::acosh,
        "atanh" => libm::atanh,
        "exp" => libm::exp,
        "cbrt" => libm::cbrt,
        "ln" | "log" => libm::log,
        "log2" => libm::log2,
        "log10" => libm::log10,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Operators and constants that need no mathematical library: IEEE arithmetic defines every bit.
    const EXACT: [&str; 20] = [
        "*", "/", "+", "-", "min", "max", "abs", "signum", "floor", "round", "ceil", "trunc",
        "fract", "sqrt", "PI", "π", "E", "e", "TAU", "τ",
    ];

    #[test]
    fn every_operator_of_a_formula_is_exact_or_comes_from_libm() {
        for operator in Operators::make() {
            let name = operator.repr();
            assert!(
                unary(name).is_some() || binary(name).is_some() || EXACT.contains(&name),
                "{name}"
            );
        }
    }

    #[test]
    fn a_replaced_operator_keeps_its_value_and_its_priority() {
        for operator in FloatOpsFactory::<f64>::make() {
            let name = operator.repr();
            if let Some(function) = unary(name) {
                let x = if name == "acosh" { 1.7 } else { 0.7 };
                let expected = (operator.unary().unwrap())(x);
                assert!((function(x) / expected - 1.0).abs() < 1e-15, "{name}");
            }
            if let Some(function) = binary(name) {
                let expected = (operator.bin().unwrap().apply)(1.3, 0.7);
                assert!((function(1.3, 0.7) / expected - 1.0).abs() < 1e-15, "{name}");
            }
        }
        let names = |operators: Vec<Operator<'static, f64>>| {
            operators.iter().map(|o| (o.repr(), o.bin().ok().map(|b| b.prio))).collect::<Vec<_>>()
        };
        assert_eq!(names(Operators::make()), names(FloatOpsFactory::<f64>::make()));
    }

    #[test]
    fn every_function_of_a_formula_has_the_bits_of_libm() {
        for operator in Operators::make() {
            let name = operator.repr();
            for i in 1..1000 {
                let x = 1e-3 * f64::from(i);
                if let Some(function) = unary(name) {
                    let x = if name == "acosh" { 1.0 + x } else { x };
                    let found = (operator.unary().unwrap())(x);
                    assert_eq!(found.to_bits(), function(x).to_bits(), "{name} of {x}");
                }
                if let Some(function) = binary(name) {
                    let found = (operator.bin().unwrap().apply)(x, 0.7);
                    assert_eq!(found.to_bits(), function(x, 0.7).to_bits(), "{name} of {x}");
                }
            }
        }
    }
}
