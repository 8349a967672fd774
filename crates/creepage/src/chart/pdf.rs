//! A figure as a PDF file: one page, lines and letters, with the font of all figures.

use crate::chart::layout::Medium;
use crate::chart::paper::LIBRARY;
use crate::chart::{Figure, draw, font};
use miniz_oxide::deflate::compress_to_vec_zlib;
use output::files::made::PDF_MARK;
use pdf_writer::types::{CidFontType, FontFlags, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use plotters::prelude::*;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind,
};
use std::collections::BTreeMap;
use std::convert::Infallible;
use ttf_parser::{Face, GlyphId};

/// From the middle of a line of letters down to its baseline, over their size: half the height of an x.
const BASELINE: f64 = 0.27;
/// A quarter of a circle by a cubic: the distance of its inner points from its ends, over the radius.
const QUARTER: f64 = 0.552_284_75;

/// Of compression.
const LEVEL: u8 = 6;
const FONT: Name<'_> = Name(b"F");
/// Its name begins as that of a font without all of its letters must.
const FONT_NAME: Name<'_> = Name(b"CREEPA+DejaVuSans");
const IDENTITY: SystemInfo<'_> =
    SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// The figure as a PDF page of that width and height (points of 1/72 inch), drawn with `unit` pixels per point; why it cannot
/// be drawn.
pub(crate) fn pdf(figure: &Figure, page: [f64; 2], unit: u32) -> Result<Vec<u8>, String> {
    let face = Face::parse(font::BYTES, 0).map_err(|error| error.to_string())?;
    let size = figure.size.map(|points| points * unit);
    let mut content = Content::new();
    let mut letters = BTreeMap::new();
    // pixels from the upper left corner
    let scale = [0, 1].map(|i| page[i] as f32 / size[i] as f32);
    content.transform([scale[0], 0.0, 0.0, -scale[1], 0.0, page[1] as f32]);
    content.set_line_join(LineJoinStyle::RoundJoin);
    {
        let canvas = Canvas { content: &mut content, letters: &mut letters, face: &face, size };
        let area = canvas.into_drawing_area();
        let drawn = draw::figure(figure, &area, f64::from(unit), Medium::Pdf);
        drawn.map_err(|error| error.to_string())?;
    }
    Ok(file(&content.finish(), page, &face, &letters))
}

/// The file of a page with this content; `letters` are the characters of its glyphs.
fn file(content: &[u8], page: [f64; 2], face: &Face<'_>, letters: &BTreeMap<u16, char>) -> Vec<u8> {
    let [info, catalog, pages, sheet, drawing, type0, rest @ ..] =
        [1, 2, 3, 4, 5, 6, 7, 8, 9, 10].map(Ref::new);
    let mut pdf = Pdf::new();
    // first: by it the program knows its files
    pdf.document_info(info).producer(TextStr(PDF_MARK));
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([sheet]).count(1);
    let mut sheet = pdf.page(sheet);
    sheet.parent(pages).media_box(Rect::new(0.0, 0.0, page[0] as f32, page[1] as f32));
    sheet.contents(drawing).resources().fonts().pair(FONT, type0);
    sheet.finish();
    pdf.stream(drawing, &compress_to_vec_zlib(content, LEVEL)).filter(Filter::FlateDecode);
    embed(&mut pdf, type0, rest, face, letters);
    pdf.finish()
}

/// Writes the font, whose characters are numbered as its glyphs are.
fn embed(
    pdf: &mut Pdf,
    type0: Ref,
    [cid, descriptor, program, unicode]: [Ref; 4],
    face: &Face<'_>,
    letters: &BTreeMap<u16, char>,
) {
    let of_em = |units: f32| units * 1000.0 / f32::from(face.units_per_em());
    pdf.type0_font(type0)
        .base_font(FONT_NAME)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(cid)
        .to_unicode(unicode);
    let advance = |glyph| of_em(f32::from(face.glyph_hor_advance(GlyphId(glyph)).unwrap_or(0)));
    let mut font = pdf.cid_font(cid);
    font.subtype(CidFontType::Type2).base_font(FONT_NAME).system_info(IDENTITY);
    font.font_descriptor(descriptor).cid_to_gid_map_predefined(Name(b"Identity"));
    font.widths().consecutive(0, (0..face.number_of_glyphs()).map(advance));
    font.finish();
    let bounds = face.global_bounding_box();
    let [left, low, right, high] = [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max]
        .map(|units| of_em(f32::from(units)));
    pdf.font_descriptor(descriptor)
        .name(FONT_NAME)
        .flags(FontFlags::NON_SYMBOLIC)
        .bbox(Rect::new(left, low, right, high))
        .italic_angle(0.0)
        .ascent(of_em(f32::from(face.ascender())))
        .descent(of_em(f32::from(face.descender())))
        .cap_height(of_em(f32::from(face.capital_height().unwrap_or(face.ascender()))))
        .stem_v(80.0)
        .font_file2(program);
    let mut stream = compress_to_vec_zlib(font::BYTES, LEVEL);
    pdf.stream(program, &stream)
        .filter(Filter::FlateDecode)
        .pair(Name(b"Length1"), font::BYTES.len() as i32);
    let mut map = UnicodeCmap::new(Name(b"Letters"), IDENTITY);
    letters.iter().for_each(|(glyph, letter)| map.pair(*glyph, *letter));
    stream = map.finish().to_vec();
    pdf.cmap(unicode, &stream);
}

/// A page to draw on.
struct Canvas<'a> {
    content: &'a mut Content,
    letters: &'a mut BTreeMap<u16, char>,
    face: &'a Face<'static>,
    /// Pixels.
    size: [u32; 2],
}

impl Canvas<'_> {
    fn ink(&mut self, colour: BackendColor) {
        let (r, g, b) = colour.rgb;
        let [r, g, b] = [r, g, b].map(|part| f32::from(part) / 255.0);
        self.content.set_fill_rgb(r, g, b).set_stroke_rgb(r, g, b);
    }

    /// Fills or strokes what was outlined.
    fn paint<S: BackendStyle>(&mut self, style: &S, fill: bool) {
        self.content.set_line_width(style.stroke_width() as f32);
        if fill {
            self.content.fill_nonzero()
        } else {
            self.content.stroke()
        };
    }

    fn outline<S: BackendStyle>(
        &mut self,
        points: impl IntoIterator<Item = BackendCoord>,
        style: &S,
        fill: bool,
    ) {
        self.ink(style.color());
        for (i, (x, y)) in points.into_iter().enumerate() {
            let (x, y) = (x as f32, y as f32);
            if i == 0 {
                self.content.move_to(x, y)
            } else {
                self.content.line_to(x, y)
            };
        }
        self.paint(style, fill);
    }

    fn glyph(&self, letter: char) -> u16 {
        self.face.glyph_index(letter).map_or(0, |glyph| glyph.0)
    }

    /// Width of a text over the size of its letters.
    fn width(&self, text: &str) -> f64 {
        let advance =
            |letter| self.face.glyph_hor_advance(GlyphId(self.glyph(letter))).unwrap_or(0);
        let units: f64 = text.chars().map(|letter| f64::from(advance(letter))).sum();
        units / f64::from(self.face.units_per_em())
    }
}

impl DrawingBackend for Canvas<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size.into()
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, colour: BackendColor) -> Drawn {
        self.draw_rect((x, y), (x + 1, y + 1), &colour, true)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        self.ink(style.color());
        self.content.rect(left as f32, top as f32, (right - left) as f32, (bottom - top) as f32);
        self.paint(style, fill);
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        self.outline(path, style, false);
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        self.ink(style.color());
        let at = |along: f64, up: f64| {
            let radius = f64::from(radius);
            [f64::from(x) + radius * along, f64::from(y) + radius * up].map(|p| p as f32)
        };
        self.content.move_to(at(1.0, 0.0)[0], at(1.0, 0.0)[1]);
        for [c, s] in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]] {
            let [[x1, y1], [x2, y2], [x3, y3]] = [
                at(c - QUARTER * s, s + QUARTER * c),
                at(QUARTER * c - s, QUARTER * s + c),
                at(-s, c),
            ];
            self.content.cubic_to(x1, y1, x2, y2, x3, y3);
        }
        self.paint(style, fill);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        self.outline(corners, style, true);
        Ok(())
    }

    /// Draws a text with its left end and its middle at a point, as [`Pen`](crate::chart::layout::Pen) asks for all of them.
    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Drawn {
        let size = style.size() / LIBRARY;
        let [along, down] = [(1, 0), (0, 1)].map(|(x, y)| {
            let (x, y) = style.transform().transform(x, y);
            [x as f32, y as f32]
        });
        let lower = (BASELINE * size) as f32;
        let [x, y] = [at.0 as f32 + lower * down[0], at.1 as f32 + lower * down[1]];
        let mut glyphs = Vec::new();
        for letter in text.chars() {
            let glyph = self.glyph(letter);
            self.letters.insert(glyph, letter);
            glyphs.extend(glyph.to_be_bytes());
        }
        self.ink(style.color());
        self.content.begin_text().set_font(FONT, size as f32);
        self.content.set_text_matrix([along[0], along[1], -down[0], -down[1], x, y]);
        self.content.show(Str(&glyphs)).end_text();
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let size = style.size() / LIBRARY;
        Ok(((size * self.width(text)).round() as u32, size.round() as u32))
    }
}
