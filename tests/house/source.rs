//! Reads Rust source files as tokens: `use` lines, paths, names defined, functions and their length, with test code left out.
//! It depends on no crate and no rule; a file's place among others is worked out from what it returns.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::BTreeSet;

/// One name that a `use` brings into scope.
#[derive(Clone, Debug, PartialEq)]
pub struct Use {
    /// The path, from its first segment on.
    pub path: Vec<String>,
    /// The name in scope; `*` for all of a module.
    pub name: String,
    /// Whether it is a re-export.
    pub public: bool,
}

/// What is in a file, test code left out of all but the functions.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// Modules declared with a file of their own.
    pub children: Vec<String>,
    /// `use` lines.
    pub uses: Vec<Use>,
    /// Paths of two segments or more in the code.
    pub paths: BTreeSet<Vec<String>>,
    /// Names defined at the top of the file.
    pub defined: BTreeSet<String>,
    /// Every identifier of the code but those of `use` lines.
    pub names: BTreeSet<String>,
    /// Every function with its number of lines, signature included; test code too.
    pub functions: Vec<(String, usize)>,
}

/// Words before the name of an item.
const ITEMS: [&str; 9] = ["fn", "struct", "enum", "trait", "type", "const", "static", "union", "mod"];

/// Reads the text of a file.
pub fn read(text: &str) -> Source {
    let tokens: TokenStream = text.parse().unwrap();
    let mut source = Source::default();
    functions(tokens.clone(), &mut source.functions);
    let tokens = without_tests(tokens);
    top(&tokens, &mut source);
    paths(&tokens, &mut source);
    source
}

fn is(token: Option<&TokenTree>, word: &str) -> bool {
    match token {
        Some(TokenTree::Ident(i)) => *i == word,
        Some(TokenTree::Punct(p)) => word.len() == 1 && word.starts_with(p.as_char()),
        _ => false,
    }
}

fn ident(token: Option<&TokenTree>) -> Option<String> {
    match token {
        Some(TokenTree::Ident(i)) => Some(i.to_string()),
        _ => None,
    }
}

fn braced(token: &TokenTree) -> Option<TokenStream> {
    match token {
        TokenTree::Group(g) if g.delimiter() == Delimiter::Brace => Some(g.stream()),
        _ => None,
    }
}

/// Index of the last token of the item that begins at `from`: its braces or its semicolon.
fn end_of_item(tokens: &[TokenTree], from: usize) -> usize {
    (from..tokens.len()).find(|i| braced(&tokens[*i]).is_some() || is(tokens.get(*i), ";")).unwrap_or(tokens.len())
}

/// The tokens without items marked `#[cfg(test)]` or `#[test]`.
fn without_tests(tokens: TokenStream) -> Vec<TokenTree> {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut kept = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        let marked = is(tokens.get(i), "#")
            && matches!(&tokens[i + 1], TokenTree::Group(g)
                if ["cfg (test)", "cfg(test)", "test"].contains(&g.stream().to_string().as_str()));
        if marked {
            i = end_of_item(&tokens, i + 2) + 1;
        } else {
            kept.push(tokens[i].clone());
            i += 1;
        }
    }
    kept
}

/// Modules, `use` lines and names at the top of a file.
fn top(tokens: &[TokenTree], source: &mut Source) {
    let mut public = false;
    let mut i = 0;
    while i < tokens.len() {
        if is(tokens.get(i), "pub") {
            public = true;
        } else if is(tokens.get(i), "use") {
            let end = end_of_use(tokens, i);
            tree(&tokens[i + 1..end], &[], public, &mut source.uses);
            (i, public) = (end, false);
        } else if let Some(word) = ident(tokens.get(i)).filter(|w| ITEMS.contains(&w.as_str())) {
            let name = ident(tokens.get(i + 1)).unwrap_or_default();
            if word == "mod" && is(tokens.get(i + 2), ";") {
                source.children.push(name);
                i += 2;
            } else if word != "const" || name != "fn" {
                source.defined.insert(name);
                i = end_of_item(tokens, i);
            }
            public = word == "const" && public;
        } else if is(tokens.get(i), "macro_rules") {
            source.defined.insert(ident(tokens.get(i + 2)).unwrap_or_default());
            i += 3;
        } else if is(tokens.get(i), "impl") {
            i = end_of_item(tokens, i);
        }
        i += 1;
    }
}

/// Index of the semicolon that ends a `use`.
fn end_of_use(tokens: &[TokenTree], from: usize) -> usize {
    (from..tokens.len()).find(|i| is(tokens.get(*i), ";")).unwrap_or(tokens.len())
}

/// A `use` tree: `a::b::{C, d as e, *}`.
fn tree(tokens: &[TokenTree], before: &[String], public: bool, uses: &mut Vec<Use>) {
    let parts = tokens.split(|t| matches!(t, TokenTree::Punct(p) if p.as_char() == ','));
    for part in parts.filter(|p| !p.is_empty()) {
        let mut path = before.to_vec();
        let mut name = None;
        for (i, token) in part.iter().enumerate() {
            match token {
                TokenTree::Group(g) => {
                    let inner: Vec<TokenTree> = g.stream().into_iter().collect();
                    tree(&inner, &path, public, uses);
                    path.clear();
                }
                TokenTree::Punct(p) if p.as_char() == '*' => name = Some("*".to_owned()),
                TokenTree::Ident(word) if *word == "as" => {
                    name = ident(part.get(i + 1));
                    break;
                }
                TokenTree::Ident(word) if *word == "self" && !path.is_empty() => {}
                TokenTree::Ident(word) => path.push(word.to_string()),
                _ => {}
            }
        }
        if let Some(last) = path.last().cloned() {
            uses.push(Use { name: name.unwrap_or(last), path, public });
        }
    }
}

/// Paths and names in the code, groups included; `use` lines are not code.
fn paths(tokens: &[TokenTree], source: &mut Source) {
    let mut i = 0;
    while i < tokens.len() {
        match &tokens[i] {
            TokenTree::Group(g) => paths(&without_tests(g.stream()), source),
            TokenTree::Ident(word) if *word == "use" => i = end_of_use(tokens, i),
            TokenTree::Ident(word) => {
                let mut path = vec![word.to_string()];
                while is(tokens.get(i + 1), ":") && is(tokens.get(i + 2), ":") {
                    let Some(next) = ident(tokens.get(i + 3)) else { break };
                    path.push(next);
                    i += 3;
                }
                source.names.extend(path.iter().cloned());
                if path.len() > 1 {
                    source.paths.insert(path);
                }
            }
            _ => {}
        }
        i += 1;
    }
}

/// Every function with a body, wherever it is.
fn functions(tokens: TokenStream, found: &mut Vec<(String, usize)>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    for (i, token) in tokens.iter().enumerate() {
        if is(Some(token), "fn")
            && let Some(name) = ident(tokens.get(i + 1))
            && let Some(body) = tokens.get(end_of_item(&tokens, i)).filter(|t| braced(t).is_some())
        {
            found.push((name, body.span().end().line - token.span().start().line + 1));
        }
        if let TokenTree::Group(g) = token {
            functions(g.stream(), found);
        }
    }
}

/// Lines of code: neither blank nor comment alone.
pub fn code_lines(text: &str) -> usize {
    text.lines().map(str::trim).filter(|l| !l.is_empty() && !l.starts_with("//")).count()
}

#[test]
fn a_source_file_is_read() {
    let text = "//! Words.\npub mod a;\nuse crate::x::{self, Y as Z, w::*};\npub use a::B;\n\n\
                pub const fn f(n: usize) -> usize {\n    super::g::h(n)\n}\nimpl Z {\n    fn k(&self) {}\n}\n\
                #[cfg(test)]\nmod tests {\n    fn t() {\n        crate::fit::f();\n    }\n}\n";
    let source = read(text);
    assert_eq!(source.children, ["a"]);
    let named: Vec<(&str, bool)> = source.uses.iter().map(|u| (u.name.as_str(), u.public)).collect();
    assert_eq!(named, [("x", false), ("Z", false), ("*", false), ("B", true)]);
    assert_eq!(source.uses[2].path, ["crate", "x", "w"]);
    assert_eq!(source.paths.iter().map(|p| p.join("::")).collect::<Vec<_>>(), ["super::g::h"]);
    assert!(source.defined.contains("f") && !source.defined.contains("k"), "{source:?}");
    assert_eq!(source.functions, [("f".to_owned(), 3), ("k".to_owned(), 1), ("t".to_owned(), 3)]);
    assert_eq!(code_lines(text), 15);
}
