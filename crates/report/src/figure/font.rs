//! The built-in fonts, for measuring and for PNG: Noto Sans, and of Noto Sans CJK SC the common
//! Chinese characters (both SIL Open Font License; fonts/README.md).

use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId};

use crate::number::pieces;

/// Size of raised characters, and the height of their baseline, over the size of the text.
pub(crate) const RAISED_SIZE: f64 = 0.72;
pub(crate) const RAISED_BY: f64 = 0.38;

static CHINESE_OTF: &[u8] = include_bytes!("../../fonts/NotoSansCJKsc-subset.otf");

/// The built-in faces; `None` cannot happen with the built-in files, and then text is left out.
struct Faces {
    regular: Option<Face<'static>>,
    bold: Option<Face<'static>>,
    chinese: Option<Face<'static>>,
}

static FACES: LazyLock<Faces> = LazyLock::new(|| Faces {
    regular: Face::parse(notosans::REGULAR_TTF, 0).ok(),
    bold: Face::parse(notosans::BOLD_TTF, 0).ok(),
    chinese: Face::parse(CHINESE_OTF, 0).ok(),
});

/// A character of a built-in face.
pub(crate) struct Glyph {
    pub(crate) face: &'static Face<'static>,
    pub(crate) id: GlyphId,
    /// Advance width over the font size.
    pub(crate) advance: f64,
}

/// The glyph of a character; the empty box where no built-in face has it.
pub(crate) fn glyph(character: char, bold: bool) -> Option<Glyph> {
    let latin = if bold { &FACES.bold } else { &FACES.regular };
    let found = [latin, &FACES.chinese]
        .into_iter()
        .flatten()
        .find_map(|face| {
            let id = face.glyph_index(character)?;
            let advance = face.glyph_hor_advance(id)?;
            Some(Glyph {
                face,
                id,
                advance: f64::from(advance) / f64::from(face.units_per_em()),
            })
        });
    found.or_else(|| {
        // One em is right for the Chinese, Japanese and Korean scripts.
        latin.as_ref().map(|face| Glyph {
            face,
            id: GlyphId(0),
            advance: 1.0,
        })
    })
}

/// Width of a line of text at a font size.
pub(crate) fn text_width(text: &str, size: f64, bold: bool) -> f64 {
    let advance = |c: char| glyph(c, bold).map_or(0.6, |glyph| glyph.advance);
    let width = |piece: &str| -> f64 { size * piece.chars().map(advance).sum::<f64>() };
    pieces(text)
        .iter()
        .map(|(piece, raised)| width(piece) * if *raised { RAISED_SIZE } else { 1.0 })
        .sum()
}

/// Breaks a text into lines no wider than `width`: at spaces, and between Chinese characters.
pub(crate) fn wrap(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        for (place, part) in parts(word).into_iter().enumerate() {
            let space = if place == 0 { " " } else { "" };
            match lines.last_mut() {
                Some(line) if text_width(&format!("{line}{space}{part}"), size, false) <= width => {
                    line.push_str(space);
                    line.push_str(&part);
                }
                _ => lines.push(part),
            }
        }
    }
    lines
}

/// A word in the parts between which a line may break.
fn parts(word: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    let mut before = None;
    for character in word.chars() {
        let breaks = before.is_none_or(|before: char| {
            let starts = is_ideograph(character) || is_ideograph(before) || closes(before);
            starts && !closes(character) && !opens(before)
        });
        match parts.last_mut() {
            Some(part) if !breaks => part.push(character),
            _ => parts.push(character.to_string()),
        }
        before = Some(character);
    }
    parts
}

fn is_ideograph(character: char) -> bool {
    matches!(character, '\u{3400}'..='\u{9fff}' | '\u{f900}'..='\u{faff}' | '\u{20000}'..='\u{3ffff}')
}

/// Chinese punctuation that never begins a line.
fn closes(character: char) -> bool {
    "、。，；：！？）》」』】”’".contains(character)
}

/// Chinese punctuation that never ends a line.
fn opens(character: char) -> bool {
    "（《「『【“‘".contains(character)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chinese_and_latin_text_break_where_readers_expect_it() {
        let width = text_width("缓冲站的偏", 10.0, false);
        let lines = wrap("缓冲站的偏移，相对于采矿船 (case a)。", 10.0, width);
        assert_eq!(lines, ["缓冲站的偏", "移，相对于", "采矿船", "(case a)。"]);
        assert_eq!(wrap("one two", 10.0, 1.0), ["one", "two"]);
        assert!(wrap("  ", 10.0, 100.0).is_empty());
    }

    #[test]
    fn a_character_that_no_face_has_is_a_box_and_not_nothing() {
        let known = glyph('缓', false).unwrap();
        assert!(known.id.0 > 0 && (known.advance - 1.0).abs() < 1e-9);
        let unknown = glyph('\u{13000}', false).unwrap();
        assert_eq!(unknown.id, GlyphId(0));
        assert!(unknown.face.glyph_bounding_box(unknown.id).is_some());
    }
}
