//! The lines of an input file: numbers, angles, names, control digits.

use thiserror::Error;

/// Why an input file is not read.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("line {line}: {problem}")]
pub struct InpError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub problem: String,
}

impl InpError {
    pub(super) fn new(line: usize, problem: impl Into<String>) -> Self {
        Self { line, problem: problem.into() }
    }
}

/// A control digit: its name, line and value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Digit {
    name: &'static str,
    line: usize,
    pub(super) value: u32,
}

impl Digit {
    /// Refuses all values but those.
    pub(super) fn one_of(&self, allowed: &[u32]) -> Result<(), InpError> {
        if allowed.contains(&self.value) {
            return Ok(());
        }
        let listed: Vec<String> = allowed.iter().map(u32::to_string).collect();
        let why = format!("half-spaces in steady rolling need {}", listed.join(" or "));
        Err(InpError::new(self.line, format!("{} = {}: {why}", self.name, self.value)))
    }
}

/// Lines without comments, and how far they are read.
pub(super) struct Reader<'a> {
    lines: Vec<(usize, &'a str)>,
    at: usize,
}

/// Numbers of a line or more: their names, and the line of the last.
#[derive(Clone, Debug)]
pub(super) struct Group {
    names: &'static [&'static str],
    values: Vec<f64>,
    pub(super) line: usize,
}

impl Group {
    /// The value at a place; zero where an optional one is left out.
    pub(super) fn get(&self, at: usize) -> f64 {
        self.values.get(at).copied().unwrap_or(0.0)
    }

    fn named(&self, name: &str) -> f64 {
        self.names.iter().position(|n| *n == name).map_or(0.0, |at| self.get(at))
    }

    /// Refuses a value that is not the one that has a meaning.
    pub(super) fn must_be(&self, name: &str, value: f64, why: &str) -> Result<(), InpError> {
        let found = self.named(name);
        if found == value {
            return Ok(());
        }
        Err(InpError::new(self.line, format!("{name} = {found}: {why}")))
    }

    /// Refuses an optional value at a place that is not zero.
    pub(super) fn must_be_zero_at(&self, at: usize, name: &str) -> Result<(), InpError> {
        let found = self.get(at);
        if found == 0.0 {
            return Ok(());
        }
        Err(InpError::new(self.line, format!("{name} = {found}: it must be 0, or left out")))
    }

    /// Refuses two values that differ.
    pub(super) fn same(&self, one: &str, other: &str) -> Result<(), InpError> {
        let value = self.named(one);
        self.must_be(other, value, &format!("half-spaces need that of {one}, {value}"))
    }
}

impl<'a> Reader<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let content = |line: &'a str| line.split('%').next().unwrap_or_default().trim();
        let lines = (1..).zip(text.lines().map(content));
        Self { lines: lines.filter(|(_, line)| !line.is_empty()).collect(), at: 0 }
    }

    pub(super) fn is_at_end(&self) -> bool {
        self.at >= self.lines.len()
    }

    /// Number of the line that comes next.
    pub(super) fn line(&self) -> usize {
        self.lines.get(self.at).or(self.lines.last()).map_or(1, |(line, _)| *line)
    }

    /// The words of the next line.
    fn words(&mut self, wanted: &str) -> Result<(usize, Vec<&'a str>), InpError> {
        let Some(&(line, text)) = self.lines.get(self.at) else {
            return Err(InpError::new(
                self.line(),
                format!("the file ends where {wanted} must stand"),
            ));
        };
        self.at += 1;
        Ok((line, text.split([' ', '\t', ',']).filter(|word| !word.is_empty()).collect()))
    }

    /// Numbers with these names, over as many lines as they take, and up to `optional` more on the last; what follows there is
    /// a comment. Angles may end in `d` (degrees) or `r`.
    pub(super) fn numbers(
        &mut self,
        names: &'static [&'static str],
        optional: usize,
    ) -> Result<Group, InpError> {
        let mut values = Vec::new();
        let mut line = self.line();
        while values.len() < names.len() {
            let words;
            (line, words) = self.words(names[values.len()])?;
            for word in words {
                match number(word) {
                    Some(value) if values.len() < names.len() + optional => values.push(value),
                    None if values.len() < names.len() => {
                        let wanted = names[values.len()];
                        return Err(InpError::new(
                            line,
                            format!("'{word}' must be {wanted}, a number"),
                        ));
                    }
                    _ => break,
                }
            }
        }
        Ok(Group { names, values, line })
    }

    /// A name in single quotes and numbers with these names behind it.
    pub(super) fn name(
        &mut self,
        names: &'static [&'static str],
        optional: usize,
    ) -> Result<(String, Group), InpError> {
        let line = self.line();
        let wrong =
            || InpError::new(line, "the name of a profile in single quotes must stand here");
        let (_, text) = *self.lines.get(self.at).ok_or_else(wrong)?;
        let mut parts = text.splitn(3, '\'');
        let (Some(""), Some(name), Some(rest)) = (parts.next(), parts.next(), parts.next()) else {
            return Err(wrong());
        };
        self.lines[self.at].1 = rest;
        Ok((name.to_owned(), self.numbers(names, optional)?))
    }

    /// A control word: its digits, of which leading zeros may be left out.
    pub(super) fn digits<const N: usize>(
        &mut self,
        names: [&'static str; N],
    ) -> Result<[Digit; N], InpError> {
        let (line, words) = self.words(names[0])?;
        let word = words.first().copied().unwrap_or_default();
        let digits: Option<Vec<u32>> = word.chars().map(|c| c.to_digit(10)).collect();
        let Some(digits) = digits.filter(|digits| digits.len() <= N) else {
            let problem = format!("'{word}' must be the digits {}", names.join(", "));
            return Err(InpError::new(line, problem));
        };
        let missing = N - digits.len();
        Ok(std::array::from_fn(|i| Digit {
            name: names[i],
            line,
            value: if i < missing { 0 } else { digits[i - missing] },
        }))
    }
}

fn number(word: &str) -> Option<f64> {
    let plain = |word: &str| word.parse().ok().filter(|x: &f64| x.is_finite());
    match (word.strip_suffix(['d', 'D']), word.strip_suffix(['r', 'R'])) {
        (Some(degrees), _) if plain(word).is_none() => plain(degrees).map(f64::to_radians),
        (_, Some(radians)) => plain(radians),
        _ => plain(word),
    }
}
