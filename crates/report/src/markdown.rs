//! Notes in Markdown as HTML that loads nothing and runs nothing.

use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};

/// Beginnings of addresses that a link may lead to; others would lead nowhere from a report.
const LINKS: [&str; 3] = ["https://", "http://", "mailto:"];

/// The note as HTML. Its headings begin at `h4`; raw HTML is shown as text; of pictures the
/// description is left, and of links to files the text.
pub(crate) fn to_html(note: &str) -> String {
    let note: String = note
        .chars()
        .filter(|c| !c.is_control() || matches!(c, '\n' | '\t'))
        .collect();
    // Whether each open link is kept.
    let mut links = Vec::new();
    let events = Parser::new_ext(&note, Options::ENABLE_TABLES).filter_map(move |event| {
        Some(match event {
            Event::Start(Tag::HtmlBlock) => Event::Start(Tag::Paragraph),
            Event::End(TagEnd::HtmlBlock) => Event::End(TagEnd::Paragraph),
            Event::Html(text) | Event::InlineHtml(text) => Event::Text(text),
            Event::Start(Tag::Image { .. }) | Event::End(TagEnd::Image) => return None,
            Event::Start(Tag::Link {
                link_type,
                dest_url,
                id,
                ..
            }) => {
                links.push(leads_out(&dest_url));
                if !leads_out(&dest_url) {
                    return None;
                }
                Event::Start(Tag::Link {
                    link_type,
                    dest_url,
                    title: CowStr::Borrowed(""),
                    id,
                })
            }
            Event::End(TagEnd::Link) if links.pop() != Some(true) => return None,
            Event::Start(Tag::Heading { level, .. }) => Event::Start(Tag::Heading {
                level: below(level),
                id: None,
                classes: Vec::new(),
                attrs: Vec::new(),
            }),
            Event::End(TagEnd::Heading(level)) => Event::End(TagEnd::Heading(below(level))),
            other => other,
        })
    });
    let mut page = String::new();
    html::push_html(&mut page, events);
    page
}

fn leads_out(address: &str) -> bool {
    let address = address.to_ascii_lowercase();
    LINKS.iter().any(|beginning| address.starts_with(beginning))
}

/// The level of a heading of a note in the page.
fn below(level: HeadingLevel) -> HeadingLevel {
    match level {
        HeadingLevel::H1 => HeadingLevel::H4,
        HeadingLevel::H2 => HeadingLevel::H5,
        _ => HeadingLevel::H6,
    }
}

#[cfg(test)]
mod tests {
    use super::to_html;

    #[test]
    fn what_notes_are_made_of() {
        let note = "# From\n\nA *paper* of **1981**, `w/L`.\n\n- one\n- two\n\n\
                    | a | b |\n| --- | --: |\n| 1 | 2 |\n";
        let html = to_html(note);
        for part in [
            "<h4>From</h4>",
            "<em>paper</em>",
            "<strong>1981</strong>",
            "<code>w/L</code>",
            "<li>one</li>",
            "<th style=\"text-align: right\">b</th>",
        ] {
            assert!(html.contains(part), "{part} in {html}");
        }
    }

    #[test]
    fn nothing_runs_and_nothing_is_loaded() {
        let note = "<script>alert(1)</script>\n\n<img src=x onerror=alert(1)> \
                    ![a plot](http://example.org/a.png) [doi](https://doi.org/10.1/x \"t\") \
                    [data](reference.csv) [bad](JaVaScRiPt:alert(1)) <i onclick='x'>y</i>\n\n\
                    [a [b](https://e.org) c](d.csv)\u{7}";
        let html = to_html(note);
        for tag in ["<script", "<img", "<i ", "src=\"", "csv\"", "javascript:"] {
            assert!(!html.to_lowercase().contains(tag), "{tag} in {html}");
        }
        assert!(html.contains("<a href=\"https://doi.org/10.1/x\">doi</a>"));
        assert!(html.contains("a plot") && html.contains(" data ") && html.contains(" bad "));
        assert_eq!(html.matches("<a ").count(), html.matches("</a>").count());
    }
}
