//! Groups of the elements of an SVG figure that say what was drawn, so that a script can read values from them.
//!
//! The group of a panel's plot has these attributes:
//! - `data-box`: left, upper, right and lower end of the plot in the units of the `viewBox`;
//! - `data-x`, `data-y`: `linear` or `log`, and the values (of `log`, their logarithms to base 10) at the left and right,
//!   or lower and upper, end of the plot;
//! - `data-x-label`, `data-y-label`: labels of the axes, with subscripts as in TeX.
//!
//! In it are groups of its content, later ones on top:
//! - of the cells of a map, `data-map`: `linear` or `log` and the values of the first and the last colour as for an axis,
//!   with `data-label` and, evenly spaced, `data-colours`; or `classes`, with a name in `data-names` for each colour;
//! - of a line, `data-line`: its name; of dots, `data-dots`. Of a dashed line, `data-gap` is the length between dashes.
//!
//! The drawing library has no groups. Their tags are drawn as texts, which [`written`] replaces.

use crate::chart::axes::Plot;
use crate::chart::fill::STOPS;
use crate::chart::label::PRIVATE;
use crate::chart::layout::{Failure, Medium, Pen, TEXT};
use crate::chart::{Axis, Draw, Key, Panel, Series};
use plotters::prelude::*;

/// Begins the text of a tag.
const TAG: char = PRIVATE[0];
/// Begins an attribute in such a text.
const ATTRIBUTE: char = PRIVATE[1];
/// Stands for what begins a subscript, so that it is not typeset as such.
const SUBSCRIPT: char = PRIVATE[2];

type Attribute = (&'static str, String);

/// Begins the group of a panel's plot.
pub(crate) fn open_plot<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    panel: &Panel,
    plot: &Plot,
) -> Result<(), Failure<DB>> {
    let (left, top) = pen.area.get_base_pixel();
    let [across, down] = [&plot.across, &plot.down];
    let ends =
        [left + across.start, top + down.start, left + across.end, top + down.end].map(i64::from);
    open(
        pen,
        &[
            ("data-box", list(&ends)),
            ("data-x", plot.x.described()),
            ("data-y", plot.y.described()),
            ("data-x-label", panel.x.label.clone()),
            ("data-y-label", panel.y.label.clone()),
        ],
    )
}

/// Begins the group of the cells of a map.
pub(crate) fn open_map<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    key: &Key,
) -> Result<(), Failure<DB>> {
    let hex = |[r, g, b]: [u8; 3]| format!("#{r:02X}{g:02X}{b:02X}");
    match key {
        Key::Values { label, range, scale } => {
            let axis = Axis { label: label.clone(), range: Some(*range), scale: *scale };
            let described = axis.ticked(std::iter::empty(), 1).described();
            let colours = list(&STOPS.map(hex));
            let label = label.clone();
            open(pen, &[("data-map", described), ("data-label", label), ("data-colours", colours)])
        }
        Key::Classes(classes) => {
            let colours: Vec<String> = classes.iter().map(|(_, colour)| hex(*colour)).collect();
            let names: Vec<&str> = classes.iter().map(|(name, _)| name.as_str()).collect();
            let names = names.join(";");
            let colours = list(&colours);
            open(
                pen,
                &[("data-map", "classes".into()), ("data-names", names), ("data-colours", colours)],
            )
        }
    }
}

/// Begins the group of a series.
pub(crate) fn open_series<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    series: &Series,
    gap: f64,
) -> Result<(), Failure<DB>> {
    let label = series.label.clone();
    match series.draw {
        Draw::Line(_) => open(pen, &[("data-line", label)]),
        Draw::Dashed(_) => open(pen, &[("data-line", label), ("data-gap", gap.to_string())]),
        Draw::Dots(..) => open(pen, &[("data-dots", label)]),
        Draw::Arrows(_) => open(pen, &[]),
    }
}

/// Ends the group that began last.
pub(crate) fn close<DB: DrawingBackend>(pen: &Pen<'_, DB>) -> Result<(), Failure<DB>> {
    tag(pen, TAG.into())
}

fn open<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    attributes: &[Attribute],
) -> Result<(), Failure<DB>> {
    let mut text = format!("{TAG}g");
    for (name, value) in attributes {
        let value = value.replace(PRIVATE, "").replace('\n', " ");
        text += &format!(
            "{ATTRIBUTE}{name}={}",
            value.replace("_{", SUBSCRIPT.encode_utf8(&mut [0; 4]))
        );
    }
    tag(pen, text)
}

fn tag<DB: DrawingBackend>(pen: &Pen<'_, DB>, text: String) -> Result<(), Failure<DB>> {
    if pen.medium != Medium::Svg {
        return Ok(());
    }
    pen.area.draw(&Text::new(text, (0, 0), pen.style(TEXT)))
}

fn list(items: &[impl ToString]) -> String {
    items.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}

/// The text of an SVG file with tags in place of the texts that stand for them. The library has escaped the values.
pub(crate) fn written(mut svg: &str) -> String {
    let mut out = String::with_capacity(svg.len());
    while let Some((before, rest)) = svg.split_once(TAG) {
        let (text, after) = rest.split_once("\n</text>\n").unwrap_or((rest, ""));
        out.push_str(&before[..before.rfind("<text").unwrap_or(before.len())]);
        let mut attributes = text.split(ATTRIBUTE);
        match attributes.next() {
            Some("") | None => out.push_str("</g>\n"),
            Some(element) => {
                out.push('<');
                out.push_str(element);
                for (name, value) in attributes.filter_map(|text| text.split_once('=')) {
                    let value = value.replace(SUBSCRIPT, "_{");
                    out.push_str(&format!(" {name}=\"{value}\""));
                }
                out.push_str(">\n");
            }
        }
        svg = after;
    }
    out + svg
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::{Cell, Figure, Fill, Scale, colour};

    fn svg(panel: Panel) -> String {
        let figure =
            Figure { size: [400, 300], columns: 1, panels: vec![panel], caption: String::new() };
        figure.svg_element().unwrap()
    }

    /// The value of the first attribute of this name.
    fn attribute<'a>(svg: &'a str, name: &str) -> &'a str {
        let from = svg.find(&format!(" {name}=\"")).expect(name) + name.len() + 3;
        svg[from..].split('"').next().unwrap()
    }

    fn numbers(text: &str) -> Vec<f64> {
        text.split([' ', ',']).filter(|part| !part.is_empty()).map(|n| n.parse().unwrap()).collect()
    }

    #[test]
    fn box_and_axes_say_where_a_point_is_drawn() {
        let points = vec![[2.0, 1e-3], [5.0, 0.4], [7.0, 90.0]];
        let draw = Draw::Line(colour::BLUE);
        let panel = Panel {
            series: vec![Series { label: "s_{1}".into(), points: points.clone(), draw }],
            ..Panel::new(Axis::linear("t (s)").over(1.0, 8.0), Axis::log("p_{n} (MPa)"))
        };
        let svg = svg(panel);
        let plot = numbers(attribute(&svg, "data-box"));
        let x = numbers(attribute(&svg, "data-x").strip_prefix("linear ").unwrap());
        let y = numbers(attribute(&svg, "data-y").strip_prefix("log ").unwrap());
        let line = &svg[svg.find("data-line").unwrap()..];
        let drawn = numbers(attribute(line, "points"));
        assert_eq!(drawn.len(), 6);
        for (point, at) in points.iter().zip(drawn.chunks(2)) {
            let across = (point[0] - x[0]) / (x[1] - x[0]);
            let up = (libm::log10(point[1]) - y[0]) / (y[1] - y[0]);
            assert!((plot[0] + across * (plot[2] - plot[0]) - at[0]).abs() <= 0.5, "{at:?}");
            assert!((plot[3] - up * (plot[3] - plot[1]) - at[1]).abs() <= 0.5, "{at:?}");
        }
        assert_eq!(attribute(&svg, "data-line"), "s_{1}");
        assert_eq!(attribute(&svg, "data-y-label"), "p_{n} (MPa)");
    }

    #[test]
    fn a_map_says_what_its_colours_mean() {
        let panel = |key: Key| {
            let cells = vec![Cell { low: [0.0; 2], high: [1.0; 2], colour: key.colour(0.1) }];
            let fill = Some(Fill { cells, key });
            Panel { fill, ..Panel::new(Axis::linear("x"), Axis::linear("y")) }
        };
        let range = [0.01, 10.0];
        let values =
            svg(panel(Key::Values { label: "|s| (m/s)".into(), range, scale: Scale::Log }));
        assert_eq!(attribute(&values, "data-map"), "log -2 1");
        assert_eq!(attribute(&values, "data-label"), "|s| (m/s)");
        let colours: Vec<&str> = attribute(&values, "data-colours").split(' ').collect();
        assert_eq!((colours.len(), colours[0], colours[8]), (9, "#440154", "#FDE725"));
        let cell = attribute(&values[values.find("data-map").unwrap()..], "fill");
        let [r, g, b] = crate::chart::viridis(1.0 / 3.0);
        assert_eq!(cell, format!("#{r:02X}{g:02X}{b:02X}"));
        let classes = vec![("stick".into(), colour::BLUE), ("slip".into(), colour::ORANGE)];
        let classes = svg(panel(Key::Classes(classes)));
        assert_eq!(attribute(&classes, "data-map"), "classes");
        assert_eq!(attribute(&classes, "data-names"), "stick;slip");
        assert_eq!(attribute(&classes, "data-colours"), "#0072B2 #E69F00");
    }

    #[test]
    fn every_group_ends_and_no_label_becomes_a_tag() {
        let evil = format!("\"><b {TAG}g{ATTRIBUTE}onload=x");
        let points = vec![[0.0, 0.0], [1.0, 1.0], [f64::NAN; 2], [2.0, 1.0], [3.0, 1.0]];
        let draws = [
            Draw::Line(colour::BLUE),
            Draw::Dashed(colour::BLUE),
            Draw::Dots(colour::BLUE, 2.0),
            Draw::Arrows(colour::BLUE),
        ];
        let series = |draw| Series { label: evil.clone(), points: points.clone(), draw };
        let svg = svg(Panel {
            title: evil.clone(),
            series: draws.map(series).into(),
            ..Panel::new(Axis::linear(&evil), Axis::linear(&evil))
        });
        assert_eq!(svg.matches("<g").count(), 5);
        assert_eq!(svg.matches("</g>").count(), 5);
        assert!(!svg.contains("<b") && !svg.contains(" onload="), "{svg}");
        assert!(!svg.contains(PRIVATE), "{svg}");
        assert_eq!(attribute(&svg, "data-gap"), "12");
        assert_eq!(svg.matches("data-line=").count(), 2);
        assert_eq!(svg.matches("data-dots=").count(), 1);
    }
}
