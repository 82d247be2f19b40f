//! Reading pages in tests.
#![allow(dead_code)]
// A panic is how a test fails, and this module is nothing but tests.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;

use roxmltree::{Document, Node, ParsingOptions};

/// The page is HTML and at the same time well-formed XML.
pub fn parse(page: &str) -> Document<'_> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(page, options).unwrap()
}

pub fn text(node: Node<'_, '_>) -> String {
    let pieces = node.descendants().filter(Node::is_text);
    let text: String = pieces.filter_map(|piece| piece.text()).collect();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The page loads nothing and runs nothing, every id stands once, and links lead somewhere.
pub fn is_self_contained(page: &str) {
    let document = parse(page);
    let mut ids = BTreeSet::new();
    for node in document.descendants().filter(Node::is_element) {
        if let Some(id) = node.attribute("id") {
            assert!(ids.insert(id), "the id {id} stands twice");
        }
        for name in ["src", "srcset", "data", "xlink:href"] {
            assert_eq!(node.attribute(name), None, "{node:?}");
        }
        let tag = node.tag_name().name();
        let loads = ["script", "img", "link", "iframe", "image"];
        assert!(!loads.contains(&tag), "{tag}");
        let handlers = node
            .attributes()
            .any(|found| found.name().starts_with("on"));
        assert!(!handlers, "{node:?}");
    }
    for link in document
        .descendants()
        .filter_map(|node| node.attribute("href"))
    {
        let id = link.strip_prefix('#').unwrap();
        assert!(ids.contains(id), "{link} leads nowhere");
    }
    for word in [
        "url(",
        "@import",
        "@font-face",
        "NaN",
        "&amp;amp;",
        "&amp;lt;",
    ] {
        assert!(!page.contains(word), "{word}");
    }
}

/// Rows of the table with this caption, as texts of their cells.
pub fn rows(document: &Document<'_>, caption: &str) -> Vec<Vec<String>> {
    let is_wanted = |node: &Node<'_, '_>| {
        let captions = node
            .children()
            .filter(|child| child.has_tag_name("figcaption"));
        node.attribute("class") == Some("table")
            && captions.clone().any(|c| text(c).contains(caption))
    };
    let tables = document.descendants().filter(is_wanted);
    let rows = tables.flat_map(|table| table.descendants());
    rows.filter(|node| node.has_tag_name("tr"))
        .map(|row| {
            let cells = row.children().filter(Node::is_element);
            cells.map(own_text).collect()
        })
        .collect()
}

/// The text of a cell without its remark.
fn own_text(cell: Node<'_, '_>) -> String {
    let is_remark = |node: &Node<'_, '_>| node.attribute("class") == Some("remark");
    let remark: String = cell.children().filter(is_remark).map(text).collect();
    let whole = text(cell);
    whole
        .strip_suffix(&remark)
        .unwrap_or(&whole)
        .trim()
        .to_owned()
}
