//! Drawing to PNG pixels.

use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash,
    Transform,
};
use ttf_parser::OutlineBuilder;

use super::drawing::{Anchor, Colour, Drawing, Mark, PAPER, Stroke as DrawnStroke, Text};
use super::font::{self, RAISED_BY, RAISED_SIZE};
use crate::ReportError;
use crate::number::pieces;

impl Drawing {
    /// The drawing as a PNG file, `scale` pixels per unit of the drawing.
    pub fn to_png(&self, scale: f64) -> Result<Vec<u8>, ReportError> {
        let fail = |what: String| ReportError::Figure {
            name: self.title.clone(),
            what,
        };
        let (width, height) = ((self.width * scale).ceil(), (self.height * scale).ceil());
        let mut pixmap = Pixmap::new(width as u32, height as u32).ok_or_else(|| {
            fail(format!(
                "{width} x {height} pixels is no size for a picture"
            ))
        })?;
        pixmap.fill(colour(PAPER));
        let transform = Transform::from_scale(scale as f32, scale as f32);
        for mark in &self.marks {
            match mark {
                Mark::Path { points, stroke } => {
                    if let Some(path) = polyline(points, false) {
                        line(&mut pixmap, &path, stroke, transform);
                    }
                }
                Mark::Shape {
                    points,
                    fill,
                    stroke,
                } => {
                    if let Some(path) = polyline(points, true) {
                        let paint = paint(*fill);
                        pixmap.fill_path(&path, &paint, FillRule::Winding, transform, None);
                        line(&mut pixmap, &path, stroke, transform);
                    }
                }
                Mark::Text(text) => {
                    if let Some(path) = outline(text) {
                        let paint = paint(text.colour);
                        pixmap.fill_path(&path, &paint, FillRule::Winding, transform, None);
                    }
                }
            }
        }
        encode(&pixmap).map_err(|error| fail(error.to_string()))
    }
}

/// A picture without transparent places as a PNG file.
///
/// Drawings are mostly paper, and rows like the one above: with differences between rows the
/// lightest compression takes a sixth of the time of the usual one, for files half as large again.
fn encode(pixmap: &Pixmap) -> Result<Vec<u8>, png::EncodingError> {
    let pixels = pixmap.pixels().iter();
    let opaque: Vec<u8> = pixels
        .flat_map(|p| [p.red(), p.green(), p.blue()])
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixmap.width(), pixmap.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_deflate_compression(png::DeflateCompression::Level(1));
    encoder.set_filter(png::Filter::Up);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&opaque)?;
    writer.finish()?;
    Ok(bytes)
}

fn line(pixmap: &mut Pixmap, path: &Path, stroke: &DrawnStroke, transform: Transform) {
    let dash = stroke.dash.iter().map(|length| *length as f32).collect();
    let style = Stroke {
        width: stroke.width as f32,
        line_join: LineJoin::Round,
        line_cap: LineCap::Butt,
        dash: StrokeDash::new(dash, 0.0),
        ..Stroke::default()
    };
    pixmap.stroke_path(path, &paint(stroke.colour), &style, transform, None);
}

fn colour([red, green, blue]: Colour) -> Color {
    Color::from_rgba8(red, green, blue, 255)
}

fn paint(ink: Colour) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(colour(ink));
    paint.anti_alias = true;
    paint
}

fn polyline(points: &[(f64, f64)], closed: bool) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for (index, (x, y)) in points.iter().enumerate() {
        if index == 0 {
            builder.move_to(*x as f32, *y as f32);
        } else {
            builder.line_to(*x as f32, *y as f32);
        }
    }
    if closed {
        builder.close();
    }
    builder.finish()
}

/// The outlines of all glyphs of a text.
fn outline(text: &Text) -> Option<Path> {
    let width = font::text_width(&text.content, text.size, text.bold);
    let shift = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * width,
        Anchor::End => -width,
    };
    let mut pen = Pen {
        builder: PathBuilder::new(),
        origin: text.at,
        along: shift,
        rise: 0.0,
        scale: 1.0,
        upwards: text.upwards,
    };
    for (piece, raised) in pieces(&text.content) {
        let (size, rise) = if raised {
            (RAISED_SIZE * text.size, RAISED_BY * text.size)
        } else {
            (text.size, 0.0)
        };
        pen.rise = rise;
        let visible = piece.chars().filter(|character| !character.is_control());
        for glyph in visible.filter_map(|character| font::glyph(character, text.bold)) {
            pen.scale = size / f64::from(glyph.face.units_per_em());
            glyph.face.outline_glyph(glyph.id, &mut pen);
            pen.along += glyph.advance * size;
        }
    }
    pen.builder.finish()
}

/// Places glyph outlines along the baseline.
struct Pen {
    builder: PathBuilder,
    origin: (f64, f64),
    along: f64,
    /// Height of the baseline above the origin.
    rise: f64,
    scale: f64,
    upwards: bool,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> (f32, f32) {
        let along = self.along + f64::from(x) * self.scale;
        let up = f64::from(y) * self.scale + self.rise;
        let (x, y) = if self.upwards {
            (self.origin.0 - up, self.origin.1 - along)
        } else {
            (self.origin.0 + along, self.origin.1 - up)
        };
        (x as f32, y as f32)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.builder.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.builder.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.place(x1, y1), self.place(x, y));
        self.builder.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2)) = (self.place(x1, y1), self.place(x2, y2));
        let (x, y) = self.place(x, y);
        self.builder.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.builder.close();
    }
}
