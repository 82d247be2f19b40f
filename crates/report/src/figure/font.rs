//! The built-in font: Noto Sans (SIL Open Font License), for measuring and for PNG.

use ttf_parser::Face;

use crate::number::pieces;

/// Size of raised characters, and the height of their baseline, over the size of the text.
pub(crate) const RAISED_SIZE: f64 = 0.72;
pub(crate) const RAISED_BY: f64 = 0.38;

/// The face for a weight; `None` cannot happen with the built-in files, and then text is left out.
pub(crate) fn face(bold: bool) -> Option<Face<'static>> {
    let bytes = if bold {
        notosans::BOLD_TTF
    } else {
        notosans::REGULAR_TTF
    };
    Face::parse(bytes, 0).ok()
}

/// Width of a line of text at a font size.
pub(crate) fn text_width(text: &str, size: f64, bold: bool) -> f64 {
    let Some(face) = face(bold) else {
        return 0.6 * size * text.chars().count() as f64;
    };
    let scale = size / f64::from(face.units_per_em());
    let width = |piece: &str| -> f64 { piece.chars().map(|c| advance(&face, c) * scale).sum() };
    pieces(text)
        .iter()
        .map(|(piece, raised)| width(piece) * if *raised { RAISED_SIZE } else { 1.0 })
        .sum()
}

/// Advance width of a character in font units. A character that the font lacks is taken as one em
/// wide, which is right for the Chinese, Japanese and Korean scripts.
pub(crate) fn advance(face: &Face<'_>, character: char) -> f64 {
    match face
        .glyph_index(character)
        .and_then(|glyph| face.glyph_hor_advance(glyph))
    {
        Some(advance) => f64::from(advance),
        None => f64::from(face.units_per_em()),
    }
}

/// Breaks a text into lines no wider than `width`.
pub(crate) fn wrap(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size, false) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
