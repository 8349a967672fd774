//! Labels with subscripts, which are written as in TeX: `p_{n}`.

/// A space at which no line of a caption or of a legend ends.
pub const NO_BREAK: &str = "\u{a0}";

/// A number with the sign of a minus.
pub fn minus(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

/// Where a subscript begins and ends in a label.
const BEGINS: &str = "_{";
const ENDS: char = '}';

/// Characters for private use, of which labels are freed: with them the tags of groups stand among the texts.
pub(crate) const PRIVATE: [char; 3] = ['\u{e000}', '\u{e001}', '\u{e002}'];

/// Size of a subscript, and how far it is lowered, both over the size of the text around it.
const SIZE: f64 = 0.7;
pub(crate) const LOWERED: f64 = 0.2;
/// Space after a subscript, over the size of the text around it.
pub(crate) const SPACE: f64 = 0.07;

/// The label up to its first subscript, the subscript, and what follows; `None` where it has none.
fn first_subscript(label: &str) -> Option<[&str; 3]> {
    let (before, rest) = label.split_once(BEGINS)?;
    let (subscript, after) = rest.split_once(ENDS)?;
    Some([before, subscript, after])
}

/// The pieces of a label in order, each with its size over that of the label: 1, or [`SIZE`] for a subscript.
pub(crate) fn runs(mut label: &str) -> Vec<(&str, f64)> {
    let mut runs = Vec::new();
    while let Some([before, subscript, after]) = first_subscript(label) {
        runs.extend([(before, 1.0), (subscript, SIZE)]);
        label = after;
    }
    runs.push((label, 1.0));
    runs.retain(|(run, _)| !run.is_empty());
    runs
}

/// The text of an SVG file in which subscripts are typeset as such.
pub(crate) fn typeset(mut svg: &str) -> String {
    let mut out = String::with_capacity(svg.len());
    while let Some([before, subscript, after]) = first_subscript(svg) {
        let lower = LOWERED / SIZE;
        out.push_str(before);
        out.push_str(&format!(
            "<tspan font-size=\"{SIZE}em\" dy=\"{lower:.3}em\">{subscript}</tspan>"
        ));
        // an element of text is a line of its own
        let (back, rest) = after.split_at(after.find(['\n', '_']).unwrap_or(after.len()));
        if !back.is_empty() {
            out.push_str(&format!("<tspan dx=\"{SPACE}em\" dy=\"-{LOWERED}em\">{back}</tspan>"));
        }
        svg = rest;
    }
    out + svg
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subscript_is_smaller_and_lower_and_what_follows_is_on_the_line_again() {
        let svg = typeset("<text>\np_{f}/p_{n} (-)\n</text>\n<text>\nrun_1\n</text>");
        assert_eq!(svg.matches("<tspan font-size=\"0.7em\" dy=\"0.286em\">").count(), 2, "{svg}");
        assert_eq!(svg.matches("dy=\"-0.2em\"").count(), 2, "{svg}");
        assert!(
            svg.contains(">f</tspan><tspan dx=\"0.07em\" dy=\"-0.2em\">/p</tspan><tspan"),
            "{svg}"
        );
        assert!(svg.contains("dy=\"-0.2em\"> (-)</tspan>\n</text>"), "{svg}");
        assert!(svg.ends_with("run_1\n</text>"), "{svg}");
    }

    #[test]
    fn a_label_falls_into_pieces_of_two_sizes() {
        let runs = |label| super::runs(label).into_iter().map(|(run, _)| run).collect::<Vec<_>>();
        assert_eq!(runs("\u{3bc}_{S} p_{n}, a_b"), ["\u{3bc}", "S", " p", "n", ", a_b"]);
        assert_eq!(super::runs("p_{n}"), [("p", 1.0), ("n", SIZE)]);
        assert_eq!(runs("p_{n"), ["p_{n"]);
        assert_eq!(typeset("p_{n"), "p_{n");
    }
}
