//! The page of a diagnosis: what it says agrees with the document, it needs nothing outside itself, and a browser shows it whole.
//! Where Chromium is not installed the tests that need it say so and check nothing.

use crate::support::written::write_study;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// A page with its document.
struct Case {
    folder: PathBuf,
    page: String,
    document: Value,
}

impl Case {
    /// Diagnoses a study of so many runs in a current \[m/s\].
    fn new(name: &str, runs: usize, current: [f64; 2]) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        write_study(&folder, runs, current);
        let output = Command::new(env!("CARGO_BIN_EXE_trimtab"))
            .current_dir(&folder)
            .args(["diagnose", "study.toml", "--out", "results", "--once"])
            .output()
            .unwrap();
        assert!(
            output.stderr.is_empty() || output.status.code() < Some(2),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let read = |file: &str| std::fs::read_to_string(folder.join("results").join(file)).unwrap();
        let document = serde_json::from_str(&read("diagnosis.json")).unwrap();
        Self { page: read("report.html"), document, folder }
    }
}

/// A current that is found.
static NAMED: LazyLock<Case> = LazyLock::new(|| Case::new("page_named", 24, [0.2, 0.1]));
/// Nothing to be found.
static NOTHING: LazyLock<Case> = LazyLock::new(|| Case::new("page_nothing", 16, [0.0, 0.0]));

fn cases() -> [&'static Case; 2] {
    [&NAMED, &NOTHING]
}

/// Elements without an end tag.
const VOID: [&str; 4] = ["meta", "br", "hr", "input"];

/// The open elements after each tag must match: the page with scripts and styles taken out.
fn assert_well_formed(page: &str) {
    let mut words = page.strip_prefix("<!DOCTYPE html>").unwrap().to_owned();
    for element in ["script", "style"] {
        while let Some(start) = words.find(&format!("<{element}")) {
            let end = words[start..].find(&format!("</{element}>")).unwrap() + start;
            words.replace_range(start..end + element.len() + 3, "");
        }
    }
    let mut open: Vec<&str> = Vec::new();
    for piece in words.split('<').skip(1) {
        let (tag, _) = piece.split_once('>').unwrap();
        let name = tag.trim_start_matches('/').split([' ', '/']).next().unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "</{name}> does not end the last element that was begun");
        } else if !tag.ends_with('/') && !VOID.contains(&name) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "not ended: {open:?}");
}

#[test]
fn the_page_is_well_formed_small_and_needs_nothing_else() {
    for case in cases() {
        assert_well_formed(&case.page);
        assert!(case.page.len() < 5_000_000, "{} bytes", case.page.len());
        for outside in ["http:", "https:", "src=", "<link", "@import", "url(http", "NaN"] {
            let words = case.page.replace("isNaN", "");
            assert!(!words.contains(outside), "{outside}: {:?}", words.find(outside).map(|i| &words[i - 60..i + 60]));
        }
    }
}

#[test]
fn every_finding_has_a_section_and_every_withdrawn_one_a_line() {
    for case in cases() {
        let lower = case.page.to_lowercase();
        for f in case.document["findings"].as_array().unwrap() {
            let title = f["title"].as_str().unwrap().to_lowercase();
            assert!(lower.contains(&format!("<h2>{title} <span class=\"grade {}\"", f["grade"].as_str().unwrap())));
        }
        for f in case.document["withdrawn"].as_array().unwrap() {
            let title = f["title"].as_str().unwrap().to_lowercase().replace('\'', "&#39;");
            assert!(lower.contains(&format!("<li>{title}")), "{title}");
        }
        let headline = case.document["headline"].as_str().unwrap();
        assert!(case.page.contains(&format!("<p class=\"verdict\">{headline}</p>")), "{headline}");
    }
    assert_eq!(NAMED.document["verdict"], "named");
    let sections = ["Where the unexplained force acts", "Proof on test runs", "What these data cannot show", "Words"];
    let rest = ["Ship and model", "Data", "Command and version", "Trial to sail next"];
    for heading in sections.iter().chain(&rest) {
        assert!(NAMED.page.contains(&format!("<h2>{heading}</h2>")), "{heading}");
    }
}

/// The value in a document at a key such as `findings[0].held_out.position[1]`.
fn at<'a>(document: &'a Value, key: &str) -> &'a Value {
    let pointer: String = key.split(['.', '[']).map(|part| format!("/{}", part.trim_end_matches(']'))).collect();
    document.pointer(&pointer).unwrap_or_else(|| panic!("{key} is on the page and not in the document"))
}

/// The numbers of a page that stand for numbers of the document: key, value, factor and text.
fn quantities(page: &str) -> Vec<(String, f64, f64, String)> {
    let attribute = |tag: &str, name: &str| {
        let rest = tag.split_once(&format!("{name}=\"")).unwrap().1;
        rest.split_once('"').unwrap().0.to_owned()
    };
    let one = |piece: &str| {
        let (tag, rest) = piece.split_once('>').unwrap();
        let text = rest.split_once("</data>").unwrap().0.to_owned();
        let number = |name: &str| attribute(tag, name).parse::<f64>().unwrap();
        (attribute(tag, "data-key"), number(" value"), number("data-factor"), text)
    };
    page.split("<data").skip(1).map(one).collect()
}

#[test]
fn every_number_that_stands_for_one_of_the_document_is_that_number() {
    for case in cases() {
        let all = quantities(&case.page);
        assert!(all.len() >= 3, "{}", all.len());
        for (key, value, factor, text) in all {
            let told = at(&case.document, &key).as_f64().unwrap();
            assert_eq!(told, value, "{key}");
            // Rounded, to no fewer than the digits that are shown.
            let shown: f64 = text.parse().unwrap_or_else(|_| panic!("{key}: {text} is no number"));
            let digits = text.trim_start_matches(['-', '0', '.']).chars().filter(char::is_ascii_digit).count().max(1);
            let decimals = text.split_once('.').map_or(0, |(_, d)| d.len()) as i32;
            let by_digits = 0.51 * 10f64.powf((value * factor).abs().max(1e-300).log10().floor() + 1.0 - digits as f64);
            let tolerance = by_digits.max(0.51 * 10f64.powi(-decimals));
            assert!((shown - value * factor).abs() <= tolerance, "{key}: {text} for {}", value * factor);
        }
    }
    assert!(quantities(&NAMED.page).len() > 20);
}

#[test]
fn the_files_that_were_read_are_on_the_page_with_date_and_checksum() {
    let manifest = std::fs::read_to_string(NAMED.folder.join("results/manifest.json")).unwrap();
    let manifest: Value = serde_json::from_str(&manifest).unwrap();
    let inputs = manifest["results"]["diagnose"]["inputs"].as_array().unwrap();
    assert!(inputs.len() > 24);
    for input in inputs {
        assert!(NAMED.page.contains(input["sha256"].as_str().unwrap()), "{input}");
    }
    assert!(NAMED.page.contains("trimtab diagnose study.toml --once") && NAMED.page.contains("Z</span>"));
}

/// Chromium, where there is one.
fn chromium() -> Option<&'static str> {
    let found = ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(|name| Command::new(name).arg("--version").output().is_ok_and(|o| o.status.success()));
    if found.is_none() {
        eprintln!("NOT TESTED: no Chromium here, so nobody looked at the page; install `chromium` to test it");
    }
    found
}

/// Runs Chromium without a window and returns what it printed: the document, and its console.
fn browse(chromium: &str, folder: &Path, arguments: &[&str]) -> (String, String) {
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new(chromium)
        .current_dir(folder)
        .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr"])
        .args(["--allow-file-access-from-files", "--disable-dev-shm-usage", "--virtual-time-budget=8000"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (text(&output.stdout), text(&output.stderr))
}

/// Opens the page in a frame of this width, uses its figures, and returns what was measured and the lines of the console.
fn shown(chromium: &str, case: &Case, width: u32) -> (Value, Vec<String>) {
    let folder = case.folder.join("results");
    let probe = format!("<script>{}</script></body>", include_str!("../support/probe.js"));
    let frame = format!("frame_{width}.html");
    std::fs::write(folder.join("probed.html"), case.page.replace("</body>", &probe)).unwrap();
    let outer = format!(
        "<!DOCTYPE html><meta charset=utf-8><body><pre id=told></pre><script>addEventListener('message', (e) => {{ \
         document.getElementById('told').textContent = e.data; }});</script>\
         <iframe src=probed.html style='border:0;width:{width}px;height:2000px'></iframe>"
    );
    std::fs::write(folder.join(&frame), outer).unwrap();
    let (dom, console) = browse(chromium, &folder, &["--window-size=1400,2100", "--dump-dom", &frame]);
    let told = dom.split_once("<pre id=\"told\">").and_then(|(_, rest)| rest.split_once("</pre>"));
    let told = told.unwrap_or_else(|| panic!("no answer from the page: {console}")).0;
    let told = told.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    let console = console.lines().filter(|l| l.contains("CONSOLE")).map(str::to_owned).collect();
    (serde_json::from_str(&told).unwrap_or_else(|e| panic!("{e}: {told}")), console)
}

#[test]
fn a_browser_shows_the_page_whole_at_1280_and_390_px_without_an_error() {
    let Some(chromium) = chromium() else { return };
    for case in cases() {
        for width in [1280, 390] {
            let (seen, console) = shown(chromium, case, width);
            assert!(console.is_empty(), "{width} px: {console:?}");
            assert_eq!(seen["errors"].as_array().map(Vec::len), Some(0), "{width} px: {seen}");
            assert_eq!(seen["width"], width, "{seen}");
            assert!(seen["content"].as_f64() <= Some(f64::from(width)), "{width} px: wider than the screen: {seen}");
            assert!(seen["smallest"].as_f64() >= Some(11.0), "{width} px: {seen}");
            assert_eq!(seen["outside"].as_array().map(Vec::len), Some(0), "{width} px: cut off: {seen}");
            assert!(seen["panels"].as_u64() > Some(8), "{seen}");
            // The figures answer to hover, zoom and the choice of a run.
            assert_eq!(
                (&seen["tip"], &seen["zoomed"], &seen["reset"]),
                (&true.into(), &true.into(), &true.into()),
                "{seen}"
            );
            assert!(seen["runs"].as_u64() > Some(3) && seen["changed"] == true, "{seen}");
        }
    }
}

#[test]
fn a_browser_prints_the_page_on_a4() {
    let Some(chromium) = chromium() else { return };
    let folder = NAMED.folder.join("results");
    let (_, console) = browse(chromium, &folder, &["--no-pdf-header-footer", "--print-to-pdf=page.pdf", "report.html"]);
    let pdf = std::fs::read(folder.join("page.pdf")).unwrap();
    assert!(pdf.starts_with(b"%PDF") && pdf.len() > 50_000, "{} bytes: {console}", pdf.len());
    assert!(!console.contains("CONSOLE"), "{console}");
    let text = String::from_utf8_lossy(&pdf);
    let pages: Vec<&str> = text.split("/MediaBox [").skip(1).map(|rest| rest.split(']').next().unwrap()).collect();
    assert!(!pages.is_empty() && pages.len() < 40, "{}", pages.len());
    for page in pages {
        let sides: Vec<f64> = page.split_whitespace().map(|v| v.parse().unwrap()).collect();
        assert!((sides[2] - 595.0).abs() < 2.0 && (sides[3] - 842.0).abs() < 2.0, "{page}");
    }
}
