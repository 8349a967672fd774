//! Writing a figure as SVG, PDF and PNG.

use crate::chart::layout::Medium;
use crate::chart::{
    Figure, Fill, Key, Panel, Paper, colour, draw, font, group, label, palette, pdf, raster,
};
use output::files::made::{self, Made, OutputRefused, XML_MARK};
use plotters::prelude::*;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use thiserror::Error;

/// Why a figure was not written.
#[derive(Debug, Error)]
pub enum FigureError {
    /// The file or its folder cannot be written.
    #[error("cannot write the figure {path}: {cause}")]
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        cause: std::io::Error,
    },
    /// Another file, which this program did not write, is in the way.
    #[error("cannot write the figure {}; {}", .0, .0.remedy())]
    Refused(#[from] OutputRefused),
    /// The drawing library failed.
    #[error("cannot draw the figure {path}: {cause}")]
    Draw {
        /// The file.
        path: PathBuf,
        /// Its message.
        cause: String,
    },
}

/// A figure is not made from files, so that it cannot overwrite its input.
const NO_INPUT: &[PathBuf] = &[];

/// Pixels per point in SVG and PDF: fine enough that rounding to pixels does not show in print.
const SVG_UNIT: u32 = 4;

/// Panels of a picture that is looked at as a whole: there the shades of edges matter less than the size of the file.
const MANY_PANELS: usize = 20;

/// A file format of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Lines and text, for print and the web.
    Svg,
    /// Lines and text, for print.
    Pdf,
    /// Pixels.
    Png,
}

impl Format {
    /// How such files of this program are recognised.
    fn made(self) -> &'static Made {
        match self {
            Self::Svg => &made::SVG,
            Self::Pdf => &made::PDF,
            Self::Png => &made::PNG,
        }
    }

    /// The extension of its files, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Pdf => "pdf",
            Self::Png => "png",
        }
    }
}

impl FromStr for Format {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut known = [Self::Svg, Self::Pdf, Self::Png].into_iter();
        known
            .find(|format| format.extension() == text)
            .ok_or("svg, pdf or png, or several with a comma between, are needed")
    }
}

impl Figure {
    /// Writes `stem.svg` and `stem.png` into `folder`, which is created if it is missing; returns
    /// their paths in this order.
    ///
    /// # Errors
    /// As [`write_as`](Self::write_as).
    pub fn write(&self, folder: &Path, stem: &str) -> Result<[PathBuf; 2], FigureError> {
        let write = |format| self.write_as(folder, stem, format, &Paper::SCREEN);
        Ok([write(Format::Svg)?, write(Format::Png)?])
    }

    /// Writes one file into `folder`, which is created if it is missing; returns its path.
    ///
    /// # Errors
    /// [`FigureError::Write`] for a folder or file that cannot be written, [`FigureError::Refused`] for a file there
    /// that this program did not write, [`FigureError::Draw`] if drawing fails.
    pub fn write_as(
        &self,
        folder: &Path,
        stem: &str,
        format: Format,
        paper: &Paper,
    ) -> Result<PathBuf, FigureError> {
        let path = folder.join(format!("{stem}.{}", format.extension()));
        let failed = |path: &Path, cause| FigureError::Write { path: path.into(), cause };
        std::fs::create_dir_all(folder).map_err(|cause| failed(folder, cause))?;
        made::check(&path, format.made(), NO_INPUT)?;
        register(&path)?;
        let undrawn = |cause: String| FigureError::Draw { path: path.clone(), cause };
        let figure = paper.lay_out(self).map_err(undrawn)?;
        let file = match format {
            Format::Svg => figure.svg(&path, paper)?.into_bytes(),
            Format::Pdf => pdf::pdf(&figure, paper.points(&figure), SVG_UNIT).map_err(undrawn)?,
            Format::Png => figure.png(paper).map_err(undrawn)?,
        };
        std::fs::write(&path, file).map_err(|cause| failed(&path, cause))?;
        Ok(path)
    }

    /// The figure as an `<svg>` element of a page that has the font of [`crate::chart::font_face`]; it
    /// scales with the page.
    ///
    /// # Errors
    /// [`FigureError::Draw`].
    pub fn svg_element(&self) -> Result<String, FigureError> {
        let (text, ..) = self.plain_svg(Path::new("page"))?;
        let (width, height) = self.pixels(SVG_UNIT);
        let page = format!("width=\"{width}\" height=\"{height}\"");
        let text = text.replacen(&page, "role=\"img\"", 1);
        let start = text.find("<svg").unwrap_or(0);
        Ok(text[start..].to_owned())
    }

    /// The figure as the text of an SVG file that carries its font.
    fn svg(&self, path: &Path, paper: &Paper) -> Result<String, FigureError> {
        let (text, width, height) = self.plain_svg(path)?;
        // the size of the page in points of 1/96 inch, and the font
        let page = format!("width=\"{width}\" height=\"{height}\"");
        let [across, up] = paper.size(self);
        let points = format!("width=\"{across}\" height=\"{up}\"");
        let text = text.replacen(&page, &points, 1);
        let head = text.find("<svg").and_then(|at| Some(at + text[at..].find('>')? + 1));
        let (head, rest) = text.split_at(head.unwrap_or(0));
        Ok(format!("{head}\n{XML_MARK}\n{}{rest}", font::style_sheet()))
    }

    /// The SVG text as the drawing library writes it, and its width and height (pixels).
    fn plain_svg(&self, path: &Path) -> Result<(String, u32, u32), FigureError> {
        register(path)?;
        let mut text = String::new();
        let (width, height) = self.pixels(SVG_UNIT);
        {
            let area = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
            let drawn = draw::figure(self, &area, f64::from(SVG_UNIT), Medium::Svg);
            drawn.and_then(|()| area.present()).map_err(|error| FigureError::Draw {
                path: path.into(),
                cause: error.to_string(),
            })?;
        }
        Ok((group::written(&label::typeset(&text)), width, height))
    }

    /// The figure as a PNG file: maps in 256 colours, lines and letters in 16 or, where it names more than half of these, in
    /// twice as many as it names.
    fn png(&self, paper: &Paper) -> Result<Vec<u8>, String> {
        let pixels = raster::pixels(self, paper.pixels(self))?;
        let exact = self.named_colours();
        let map = |panel: &Panel| matches!(&panel.fill, Some(Fill { key: Key::Values { .. }, .. }));
        let most = match self.panels.len() {
            _ if self.panels.iter().any(map) => 256,
            MANY_PANELS.. => exact.len() + palette::GREYS,
            _ => (2 * exact.len()).max(16),
        };
        palette::png(&pixels, &exact, most.min(256), paper.per_metre())
            .map_err(|error| error.to_string())
    }

    /// The colours of paper, letters, series, marks and classes.
    fn named_colours(&self) -> Vec<[u8; 3]> {
        let mut all = BTreeSet::from([colour::WHITE, colour::BLACK]);
        for panel in &self.panels {
            all.extend(panel.series.iter().map(|series| series.draw.colour()));
            all.extend(panel.marks.iter().map(|mark| mark.colour));
            if let Some(Fill { key: Key::Classes(classes), .. }) = &panel.fill {
                all.extend(classes.iter().map(|(_, colour)| *colour));
            }
        }
        all.into_iter().collect()
    }

    fn pixels(&self, unit: u32) -> (u32, u32) {
        (self.size[0] * unit, self.size[1] * unit)
    }
}

/// Makes the font known to the drawing library.
fn register(path: &Path) -> Result<(), FigureError> {
    let cause = || "the font cannot be read".into();
    font::register()
        .then_some(())
        .ok_or_else(|| FigureError::Draw { path: path.into(), cause: cause() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::{Axis, Cell, Draw, Mark, NO_BREAK, Scale, Series};

    fn figure() -> Figure {
        let points = (0..100).map(|i| [f64::from(i), libm::sin(f64::from(i))]).collect();
        let panel = Panel {
            title: "A title".into(),
            series: vec![Series { label: "sine".into(), points, draw: Draw::Line(colour::BLUE) }],
            marks: vec![Mark { x: 50.0, label: "half".into(), colour: colour::VERMILION }],
            ..Panel::new(Axis::linear("t (s)"), Axis::linear("x (m)"))
        };
        Figure { size: [400, 300], columns: 1, panels: vec![panel], caption: String::new() }
    }

    #[test]
    fn a_figure_is_written_as_svg_with_its_font_and_labels_and_as_png() {
        let folder = tempfile::tempdir().unwrap();
        let [svg, png] = figure().write(&folder.path().join("new"), "one").unwrap();
        let svg = std::fs::read_to_string(svg).unwrap();
        for part in ["width=\"400\"", "@font-face", "t (s)", "x (m)", "sine", "half", "A title"] {
            assert!(svg.contains(part), "{part}");
        }
        let png = std::fs::read(png).unwrap();
        assert_eq!(&png[1..4], b"PNG");
        assert_eq!(std::fs::read_dir(folder.path().join("new")).unwrap().count(), 2);
        assert_eq!(png[16..24], [0, 0, 3, 32, 0, 0, 2, 88]); // 800 x 600
    }

    #[test]
    fn a_figure_replaces_a_figure_of_this_program_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let paths = figure().write(folder.path(), "one").unwrap();
        let first = paths.clone().map(|path| std::fs::read(path).unwrap());
        figure().write(folder.path(), "one").unwrap();
        assert_eq!(first, paths.clone().map(|path| std::fs::read(path).unwrap()));
        for (path, format) in paths.iter().zip([Format::Svg, Format::Png]) {
            for theirs in [&b"<svg><!-- mine --></svg>"[..], b"\x89PNG\r\n\x1a\nmine"] {
                std::fs::write(path, theirs).unwrap();
                let error =
                    figure().write_as(folder.path(), "one", format, &Paper::SCREEN).unwrap_err();
                assert!(error.to_string().contains("not a figure that this program"), "{error}");
                assert_eq!(std::fs::read(path).unwrap(), theirs);
            }
        }
    }

    #[test]
    fn a_map_shows_its_cells_its_colours_and_its_caption_in_lines() {
        let mut figure = figure();
        let key = Key::Values { label: "|s| (m/s)".into(), range: [0.01, 10.0], scale: Scale::Log };
        let cells = (0..10).map(|i| Cell {
            low: [f64::from(i), -1.0],
            high: [f64::from(i + 1), 1.0],
            colour: key.colour(f64::from(i)),
        });
        figure.panels[0].fill = Some(Fill { cells: cells.collect(), key: key.clone() });
        figure.caption = "words that fill more than a line ".repeat(5);
        let svg = figure.svg_element().unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(svg.contains("|s| (m/s)"));
        assert!(svg.matches("words that fill").count() >= 3, "the caption is not broken");
        for class in [Key::Classes(vec![("stick".into(), colour::BLUE)]), key] {
            figure.panels[0].fill = Some(Fill { cells: vec![], key: class });
            figure.svg_element().unwrap();
        }
    }

    #[test]
    fn on_paper_a_figure_has_its_width_at_300_dpi_and_panels_below_one_another_where_there_is_no_room()
     {
        let folder = tempfile::tempdir().unwrap();
        let mut figure = figure();
        figure.panels.push(figure.panels[0].clone());
        (figure.columns, figure.caption) = (2, "words that fill more than a line ".repeat(5));
        let paper = Paper { width: Some(60.0), font_size: Some(11.0), caption: false };
        let write = |format| figure.write_as(folder.path(), "one", format, &paper).unwrap();
        let svg = std::fs::read_to_string(write(Format::Svg)).unwrap();
        assert!(svg.starts_with("<svg width=\"60.00mm\""), "{}", &svg[..120]);
        assert!(!svg.contains("words that"));
        let numbers = |name: &str| {
            let attribute = format!("{name}=\"");
            let values = svg.split(&attribute).skip(1);
            values.map(|text| text.split('"').next().unwrap().to_owned()).collect::<Vec<_>>()
        };
        let left: Vec<_> =
            numbers("data-box").iter().map(|b| b.split(' ').next().unwrap().to_owned()).collect();
        assert_eq!(left[0], left[1], "the panels stand beside each other");
        // letters of 11 points, 1/72 inch each, where the figure is 60 mm wide
        let across: f64 = numbers("viewBox")[0].split(' ').nth(2).unwrap().parse().unwrap();
        let letters: Vec<f64> =
            numbers("font-size").iter().filter_map(|size| size.parse().ok()).collect();
        let least = letters.into_iter().fold(f64::INFINITY, f64::min) / across * 60.0 / 25.4 * 72.0;
        assert!((least / 11.0 - 1.0).abs() < 0.02, "{least}");
        let png = std::fs::read(write(Format::Png)).unwrap();
        let wide = u32::from_be_bytes(png[16..20].try_into().unwrap());
        assert_eq!(wide, 709); // 60 mm at 300 per inch
        let at = png.windows(4).position(|kind| kind == b"pHYs").unwrap();
        assert_eq!(u32::from_be_bytes(png[at + 4..at + 8].try_into().unwrap()), 11811);
    }

    #[test]
    fn a_pdf_is_as_wide_as_asked_for_and_holds_its_letters_as_text() {
        let folder = tempfile::tempdir().unwrap();
        let mut figure = figure();
        figure.caption = "\u{3bc}_{S} = 0.5, creepage \u{2212}2.4\u{b7}10\u{207b}\u{b3}".into();
        let paper = Paper { width: Some(90.0), ..Paper::SCREEN };
        let write = || figure.write_as(folder.path(), "one", Format::Pdf, &paper).unwrap();
        let (path, first) = (write(), std::fs::read(write()).unwrap());
        assert_eq!(std::fs::read(&path).unwrap(), first);
        let text: String = first.iter().map(|byte| char::from(*byte)).collect();
        assert!(text.starts_with("%PDF-1.") && text.ends_with("%%EOF"), "{text}");
        let after = |mark: &str| text[text.rfind(mark).unwrap() + mark.len()..].trim_start();
        let xref: usize = after("startxref").split_whitespace().next().unwrap().parse().unwrap();
        assert!(text[text.char_indices().nth(xref).unwrap().0..].starts_with("xref"));
        let page: Vec<f64> =
            after("/MediaBox [").split([' ', ']']).take(4).map(|n| n.parse().unwrap()).collect();
        assert_eq!(page[..2], [0.0, 0.0]);
        assert!((page[2] / 72.0 * 25.4 - 90.0).abs() < 1e-3, "{page:?}");
        for letter in ["03BC", "2212", "00B7", "207B", "00B3"] {
            assert!(text.contains(&format!("> <{letter}>")), "{letter}");
        }
        std::fs::write(&path, "%PDF-1.7 theirs").unwrap();
        assert!(figure.write_as(folder.path(), "one", Format::Pdf, &paper).is_err());
    }

    #[test]
    fn a_number_and_its_unit_stand_on_one_line_of_a_caption() {
        let mut figure = figure();
        figure.caption = format!("h{NO_BREAK}={NO_BREAK}2.00{NO_BREAK}mm, ").repeat(30);
        let svg = figure.svg_element().unwrap();
        let lines: Vec<_> = svg.lines().filter(|line| line.starts_with("h = ")).collect();
        assert!(lines.len() > 3 && lines.iter().all(|line| line.ends_with("mm,")), "{lines:?}");
        assert!(!svg.contains(NO_BREAK));
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let error = figure().write(&file.path().join("in"), "one").unwrap_err();
        assert!(error.to_string().contains("cannot write the figure"), "{error}");
    }

    #[test]
    fn data_that_are_not_numbers_leave_gaps_and_do_no_harm() {
        let folder = tempfile::tempdir().unwrap();
        let mut figure = figure();
        figure.panels[0].series[0].points[7][1] = f64::NAN;
        figure.panels[0].series[0].points[9][0] = f64::INFINITY;
        figure.panels[0].y = Axis::log("x (m)");
        figure.write(folder.path(), "gaps").unwrap();
    }
}
