use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use super::*;
use crate::figure::font::glyph;

/// Beginnings of keys that are put together from words of the store.
const BUILT: [&str; 6] = [
    "quantity.",
    "joint.",
    "motion.",
    "setting.",
    "word.",
    "energy.",
];

/// The sources and templates that use messages.
fn sources() -> String {
    fn read(folder: &Path, text: &mut String) {
        for entry in fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                read(&path, text);
            } else if !path.ends_with("words/messages.rs") && !path.ends_with("words/tests.rs") {
                text.push_str(&fs::read_to_string(&path).unwrap());
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut text = String::new();
    read(&root.join("src"), &mut text);
    read(&root.join("templates"), &mut text);
    text
}

/// The names in braces.
fn places(text: &str) -> BTreeSet<&str> {
    let after = text.split('{').skip(1);
    after
        .filter_map(|part| part.split_once('}'))
        .map(|(name, _)| name)
        .collect()
}

#[test]
fn every_key_is_there_once_in_both_languages_with_the_same_values() {
    let mut keys = BTreeSet::new();
    for message in MESSAGES {
        let Message {
            key,
            english,
            chinese,
        } = message;
        assert!(keys.insert(key), "{key} stands twice");
        assert!(!english.is_empty(), "{key} has no English text");
        assert!(
            !chinese.is_empty() || *key == "page.after_number",
            "{key} has no Chinese text"
        );
        assert_eq!(places(english), places(chinese), "{key}");
    }
}

#[test]
fn no_key_is_unused_and_none_is_missing() {
    let sources = sources();
    for message in MESSAGES {
        let built = BUILT
            .iter()
            .any(|beginning| message.key.starts_with(beginning));
        let used = sources.contains(&format!("\"{}\"", message.key));
        assert!(built || used, "nothing uses {}", message.key);
    }
    let sections: BTreeSet<&str> = MESSAGES
        .iter()
        .filter_map(|message| message.key.split_once('.'))
        .map(|(section, _)| section)
        .collect();
    for quoted in sources.split('"') {
        let Some((section, name)) = quoted.split_once('.') else {
            continue;
        };
        let is_key = sections.contains(section)
            && !name.is_empty()
            && name.chars().all(|c| c.is_ascii_lowercase() || c == '_');
        // File names of templates and modules look like keys too.
        let is_file = ["html", "css", "rs", "svg", "png"].contains(&name);
        if is_key && !is_file {
            assert!(
                Language::English.find(quoted).is_some(),
                "no text for {quoted}"
            );
        }
    }
}

#[test]
fn the_words_of_the_field_are_the_right_ones() {
    for (key, chinese) in [
        ("quantity.effective_tension", "有效张力"),
        ("quantity.bend_moment", "弯矩"),
        ("quantity.curvature", "曲率"),
        ("quantity.von_mises_stress", "冯·米塞斯应力"),
    ] {
        assert_eq!(Language::Chinese.text(key), chinese);
    }
}

#[test]
fn pictures_have_every_character_of_the_messages() {
    for (code, language) in Language::ALL {
        for character in language.characters() {
            let glyph = glyph(character, false).unwrap();
            assert!(glyph.id.0 > 0, "{code}: no glyph for {character:?}");
        }
    }
}

#[test]
fn values_are_filled_in_once() {
    let text = Language::English.fill("shapes.seen", &[("what", "{view} {"), ("view", "a & b")]);
    assert_eq!(text, "{view} {, a & b");
}

#[test]
fn channels_in_words() {
    for (channel, english, chinese) in [
        (
            "hose.end_b.force_x",
            "hose, end B, force x",
            "hose，B 端，x 向力",
        ),
        ("buffer.offset_x", "buffer, offset x", "buffer，x 向偏移"),
        (
            "a.b.effective_tension@12.5 m",
            "a.b, effective tension at 12.5 m",
            "a.b，12.5 m 处的有效张力",
        ),
        (
            "line.something_new",
            "line, something new",
            "line，something new",
        ),
        ("odd", "odd", "odd"),
    ] {
        assert_eq!(Language::English.channel(channel), english);
        assert_eq!(Language::Chinese.channel(channel), chinese);
    }
}
