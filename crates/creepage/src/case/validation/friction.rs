//! The friction law has the keys that it uses, no others, and they agree.

use friction::{DYNAMIC, Expression, LAWS, Parameters, STATIC};

use super::Findings;
use crate::case::friction_law;
use crate::case::keys;
use crate::case::schema::Case;
use crate::case::value::{number, quoted};

/// A formula is evaluated at every node in contact in every step, and some 200,000 times before.
const LONGEST_FORMULA: usize = 4000;

/// Checks the keys of the law.
pub(super) fn check(friction: &Parameters, found: &mut Findings<'_>) {
    let uses = friction.declaration();
    let law = format!("friction.law = \"{}\"", uses.word);
    for key in friction.given().filter(|key| !uses.has(key)) {
        let path = friction_law::path(key);
        let others = LAWS.iter().filter(|other| other.has(key)).map(|other| other.word);
        let others = quoted(&others.collect::<Vec<_>>());
        let remedy = format!("leave it out, or set friction.law = {others}");
        found.require(false, &[&path], format_args!("{path} is not used with {law}"), &remedy);
    }
    for key in uses.needs().filter(|&key| !friction.given().any(|given| given == key)) {
        let path = friction_law::path(key);
        let row = keys::find(&path);
        let (allowed, remedy) = row.map(|row| (row.allowed(), row.remedy)).unwrap_or_default();
        found.require(
            false,
            &["friction.law", "friction"],
            format_args!("{path} is missing: {law} needs it, {allowed}"),
            &format!("in [friction] {remedy}"),
        );
    }
    let (rest, dynamic) = (friction.value(STATIC), friction.value(DYNAMIC));
    found.require(
        dynamic <= rest || !uses.has("dynamic"),
        &["friction.dynamic", "friction.static"],
        format_args!(
            "friction.dynamic = {} must be at most friction.static = {}",
            number(dynamic),
            number(rest)
        ),
        "friction falls with slip velocity in this law: swap the two coefficients",
    );
}

/// A formula gives a coefficient of friction at every pressure, time and place of the case.
pub(super) fn check_formula(case: &Case, found: &mut Findings<'_>) {
    let Some(text) = &case.friction.expression else { return };
    let length = text.chars().count();
    found.require(
        length <= LONGEST_FORMULA,
        &["friction.expression"],
        format_args!(
            "friction.expression has {length} characters, more than {LONGEST_FORMULA}: it is evaluated at every node \
             in contact in every step"
        ),
        "give a measured curve as friction.table, which may have any length, or write a shorter formula",
    );
    if length > LONGEST_FORMULA {
        return;
    }
    let wrong = Expression::over(text, &friction_law::domain(case)).err();
    found.require(
        wrong.is_none(),
        &["friction.expression"],
        format_args!("friction.expression: {}", wrong.map_or(String::new(), |wrong| wrong.to_string())),
        "write a formula that is a coefficient of friction everywhere: max(p, 1e3) keeps clear of a \
         division by zero, max(0.1, ...) of a negative value",
    );
}
