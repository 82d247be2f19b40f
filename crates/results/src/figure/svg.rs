//! Drawing to SVG text.

use std::fmt::Write;

use super::drawing::{Anchor, Drawing, Mark, Text};

/// Fonts by preference: the built-in one where it is installed, then what most systems have.
const FONTS: &str = "'Noto Sans','Helvetica Neue',Arial,'Liberation Sans',sans-serif";

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
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
            escape(title)
        );
        for mark in marks {
            match mark {
                Mark::Path { points, stroke } => {
                    let [r, g, b] = stroke.colour;
                    // Writing to a string cannot fail.
                    let _ = write!(
                        svg,
                        "<polyline fill=\"none\" stroke=\"#{r:02x}{g:02x}{b:02x}\" \
                         stroke-width=\"{}\" stroke-linejoin=\"round\"",
                        stroke.width
                    );
                    if !stroke.dash.is_empty() {
                        let dash: Vec<String> = stroke
                            .dash
                            .iter()
                            .map(|length| length.to_string())
                            .collect();
                        let _ = write!(svg, " stroke-dasharray=\"{}\"", dash.join(" "));
                    }
                    let points: Vec<String> = points
                        .iter()
                        .map(|(x, y)| format!("{x:.1},{y:.1}"))
                        .collect();
                    let _ = writeln!(svg, " points=\"{}\"/>", points.join(" "));
                }
                Mark::Text(text) => write_text(&mut svg, text),
            }
        }
        svg.push_str("</svg>\n");
        svg
    }
}

fn write_text(svg: &mut String, text: &Text) {
    let (x, y) = text.at;
    let [r, g, b] = text.colour;
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
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{}\" text-anchor=\"{anchor}\" \
         fill=\"#{r:02x}{g:02x}{b:02x}\"{weight}{rotate}>{}</text>",
        text.size,
        escape(&text.content)
    );
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
            c if c.is_control() => {}
            c => escaped.push(c),
        }
    }
    escaped
}
