//! Drawing to SVG text.

use std::fmt::Write;

use super::drawing::{Anchor, Colour, Drawing, Mark, PAPER, Stroke, Text};
use super::font::{RAISED_BY, RAISED_SIZE};
use crate::number::pieces;

/// Fonts by preference: the built-in one where it is installed, then what most systems have.
const FONTS: &str = "'Noto Sans','Helvetica Neue',Arial,'Liberation Sans','Noto Sans CJK SC',\
                     'Microsoft YaHei','PingFang SC','Source Han Sans SC',sans-serif";

impl Drawing {
    /// The drawing as an SVG document.
    pub fn to_svg(&self) -> String {
        let Drawing {
            width,
            height,
            title,
            marks,
        } = self;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\" role=\"img\">\n\
             <title>{}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"{}\"/>\n",
            escape(title),
            hex(PAPER)
        );
        for mark in marks {
            match mark {
                Mark::Path { points, stroke } => {
                    write_line(&mut svg, "polyline", "none", points, stroke);
                }
                Mark::Shape {
                    points,
                    fill,
                    stroke,
                } => write_line(&mut svg, "polygon", &hex(*fill), points, stroke),
                Mark::Text(text) => write_text(&mut svg, text),
            }
        }
        svg.push_str("</svg>\n");
        svg
    }
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

// Writing to a string cannot fail, so the results of `write!` are dropped.
fn write_line(svg: &mut String, tag: &str, fill: &str, points: &[(f64, f64)], stroke: &Stroke) {
    let _ = write!(
        svg,
        "<{tag} fill=\"{fill}\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"",
        hex(stroke.colour),
        stroke.width
    );
    if !stroke.dash.is_empty() {
        let dash: Vec<String> = stroke.dash.iter().map(f64::to_string).collect();
        let _ = write!(svg, " stroke-dasharray=\"{}\"", dash.join(" "));
    }
    let points: Vec<String> = points
        .iter()
        .map(|(x, y)| format!("{x:.1},{y:.1}"))
        .collect();
    let _ = writeln!(svg, " points=\"{}\"/>", points.join(" "));
}

fn write_text(svg: &mut String, text: &Text) {
    let (x, y) = text.at;
    let anchor = match text.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let weight = if text.bold {
        " font-weight=\"bold\""
    } else {
        ""
    };
    let rotate = if text.upwards {
        format!(" transform=\"rotate(-90 {x:.1} {y:.1})\"")
    } else {
        String::new()
    };
    let _ = write!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{}\" text-anchor=\"{anchor}\" \
         fill=\"{}\"{weight}{rotate}>",
        text.size,
        hex(text.colour)
    );
    let mut height = 0.0;
    for (piece, raised) in pieces(&text.content) {
        let (size, rise) = if raised {
            (RAISED_SIZE * text.size, RAISED_BY * text.size)
        } else {
            (text.size, 0.0)
        };
        let piece = escape(&piece);
        if rise == height {
            svg.push_str(&piece);
        } else {
            let shift = height - rise;
            let _ = write!(
                svg,
                "<tspan dy=\"{shift:.1}\" font-size=\"{size:.1}\">{piece}</tspan>"
            );
        }
        height = rise;
    }
    svg.push_str("</text>\n");
}

/// Text as XML content; characters that XML forbids are dropped.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => escaped.push(c),
        }
    }
    escaped
}
