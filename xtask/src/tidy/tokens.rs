//! Rust sources as flat token lists: no comments, no string contents, test code marked.
//!
//! Rules that look at words must not trip over a comment that explains them, nor over a test that
//! may do what the library may not.

use std::str::FromStr;

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

/// One token; a string literal keeps its quotes, so that it never equals a word.
#[derive(Debug, Clone)]
pub(crate) struct Token {
    pub text: String,
    pub line: usize,
    /// Inside an item under `#[test]` or `#[cfg(test)]`.
    pub in_test: bool,
    is_word: bool,
}

/// A path such as `std::fs::read`, written out or collected from a `use` with braces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SourcePath {
    pub segments: Vec<String>,
    pub line: usize,
    pub in_test: bool,
}

/// The tokens of a source text, or the reason why it is not Rust.
pub(crate) fn tokenize(text: &str) -> Result<Vec<Token>, String> {
    let stream = TokenStream::from_str(text).map_err(|error| error.to_string())?;
    let mut tokens = Vec::new();
    flatten(stream, false, &mut tokens);
    Ok(tokens)
}

/// Names of the modules in files of their own that are compiled for tests only
/// (`#[cfg(test)] mod cases;`).
pub(crate) fn test_modules(tokens: &[Token]) -> Vec<&str> {
    tokens
        .windows(3)
        .filter(|window| window[0].in_test && window[0].text == "mod" && window[2].text == ";")
        .map(|window| window[1].text.as_str())
        .collect()
}

/// All paths of two or more segments, `use` trees expanded.
pub(crate) fn paths(tokens: &[Token]) -> Vec<SourcePath> {
    let mut found = Vec::new();
    let mut index = 0;
    while index < tokens.len() {
        if tokens[index].is_word {
            index = read_path(tokens, index, &[], &mut found);
        } else {
            index += 1;
        }
    }
    found.retain(|path| path.segments.len() > 1);
    found
}

fn flatten(stream: TokenStream, mut in_test: bool, tokens: &mut Vec<Token>) {
    let trees: Vec<TokenTree> = stream.into_iter().collect();
    // Set by a test attribute; ends with the item it stands on.
    let mut item_is_test = false;
    for (index, tree) in trees.iter().enumerate() {
        let mut push = |text: String, is_word| {
            let line = tree.span().start().line;
            tokens.push(Token {
                text,
                line,
                in_test: in_test || item_is_test,
                is_word,
            });
        };
        match tree {
            TokenTree::Ident(word) => push(word.to_string(), true),
            TokenTree::Literal(literal) => push(literal.to_string(), false),
            TokenTree::Punct(mark) => {
                push(mark.as_char().to_string(), false);
                if mark.as_char() == ';' {
                    item_is_test = false;
                }
            }
            TokenTree::Group(group) => {
                match attribute_before(&trees, index) {
                    Some(Attribute::Outer) if is_test_attribute(group) => item_is_test = true,
                    Some(Attribute::Inner) if is_test_attribute(group) => in_test = true,
                    _ => {}
                }
                flatten_group(group, in_test || item_is_test, tokens);
                if group.delimiter() == Delimiter::Brace {
                    item_is_test = false;
                }
            }
        }
    }
}

fn flatten_group(group: &Group, in_test: bool, tokens: &mut Vec<Token>) {
    let (open, close) = match group.delimiter() {
        Delimiter::Parenthesis => ("(", ")"),
        Delimiter::Brace => ("{", "}"),
        Delimiter::Bracket => ("[", "]"),
        Delimiter::None => ("", ""),
    };
    let mark = |text: &str, line| Token {
        text: text.to_owned(),
        line,
        in_test,
        is_word: false,
    };
    tokens.push(mark(open, group.span_open().start().line));
    flatten(group.stream(), in_test, tokens);
    tokens.push(mark(close, group.span_close().start().line));
}

enum Attribute {
    Outer,
    Inner,
}

/// Whether the tree at `index` follows `#` (outer attribute) or `#!` (inner attribute).
fn attribute_before(trees: &[TokenTree], index: usize) -> Option<Attribute> {
    let mark = |back: usize| match trees.get(index.checked_sub(back)?)? {
        TokenTree::Punct(mark) => Some(mark.as_char()),
        _ => None,
    };
    match (mark(2), mark(1)) {
        (_, Some('#')) => Some(Attribute::Outer),
        (Some('#'), Some('!')) => Some(Attribute::Inner),
        _ => None,
    }
}

/// `[test]`, `[rstest]`, `[some::test]`, or `[cfg(..)]` that asks for `test`.
fn is_test_attribute(group: &Group) -> bool {
    if group.delimiter() != Delimiter::Bracket {
        return false;
    }
    let words = words_of(group.stream());
    match words.first().map(String::as_str) {
        Some("cfg") => words.iter().any(|w| w == "test") && !words.iter().any(|w| w == "not"),
        Some("cfg_attr") => false,
        Some("test" | "rstest") => true,
        _ => words.len() == 2 && words[1] == "test",
    }
}

fn words_of(stream: TokenStream) -> Vec<String> {
    let mut words = Vec::new();
    for tree in stream {
        match tree {
            TokenTree::Ident(word) => words.push(word.to_string()),
            TokenTree::Group(group) => words.extend(words_of(group.stream())),
            _ => {}
        }
    }
    words
}

/// Reads the path that starts at `start` behind `prefix`; returns the index after it.
fn read_path(
    tokens: &[Token],
    start: usize,
    prefix: &[String],
    found: &mut Vec<SourcePath>,
) -> usize {
    let text = |index: usize| tokens.get(index).map_or("", |token| token.text.as_str());
    let mut segments = prefix.to_vec();
    segments.push(text(start).to_owned());
    let mut index = start + 1;
    while text(index) == ":" && text(index + 1) == ":" {
        index += 2;
        if tokens.get(index).is_some_and(|token| token.is_word) || text(index) == "*" {
            segments.push(text(index).to_owned());
            index += 1;
        } else if text(index) == "{" {
            index += 1;
            while index < tokens.len() && text(index) != "}" {
                if tokens[index].is_word || text(index) == "*" {
                    index = read_path(tokens, index, &segments, found);
                } else {
                    index += 1;
                }
            }
            return index + 1;
        } else {
            break;
        }
    }
    if text(index) == "as" && !prefix.is_empty() {
        index += 2;
    }
    let Token { line, in_test, .. } = tokens[start];
    found.push(SourcePath {
        segments,
        line,
        in_test,
    });
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(text: &str) -> Vec<String> {
        let tokens = tokenize(text).expect("the snippet is Rust");
        paths(&tokens)
            .into_iter()
            .map(|path| path.segments.join("::"))
            .collect()
    }

    #[test]
    fn use_trees_are_expanded() {
        assert_eq!(
            joined("use std::{fs, io::{self, Write as _}, time::*};\nuse crate::hydro;"),
            [
                "std::fs",
                "std::io::self",
                "std::io::Write",
                "std::time::*",
                "crate::hydro"
            ]
        );
    }

    #[test]
    fn paths_in_expressions_types_and_macros_are_found() {
        let text = "fn f(t: std::time::Instant) { g!(std::fs::read(p)); Vec::<u8>::new(); }";
        assert_eq!(joined(text), ["std::time::Instant", "std::fs::read"]);
    }

    #[test]
    fn comments_and_strings_hold_no_words() {
        let tokens = tokenize("// println\n/* dbg */ const A: &str = \"todo\";").expect("Rust");
        assert!(
            tokens
                .iter()
                .all(|token| !["println", "dbg", "todo"].contains(&&*token.text))
        );
    }

    #[test]
    fn test_items_are_marked_and_their_neighbours_are_not() {
        let text = "fn a() {}\n#[cfg(test)]\nmod tests { fn b() {} }\nfn c() {}\n\
                    #[test]\nfn d() -> [u8; 3] { e() }\n#[cfg(not(test))]\nfn f() {}\n\
                    #[cfg(test)]\nuse x::{g, h};\nfn i() {}";
        let tokens = tokenize(text).expect("the snippet is Rust");
        let marked = |word: &str| {
            tokens
                .iter()
                .find(|token| token.text == word)
                .map(|t| t.in_test)
        };
        for word in ["b", "d", "e", "g"] {
            assert_eq!(marked(word), Some(true), "{word}");
        }
        for word in ["a", "c", "f", "i"] {
            assert_eq!(marked(word), Some(false), "{word}");
        }
    }

    #[test]
    fn test_modules_in_files_are_listed() {
        let tokens = tokenize("mod a;\n#[cfg(test)]\nmod cases;\nmod b;").expect("Rust");
        assert_eq!(test_modules(&tokens), ["cases"]);
    }
}
