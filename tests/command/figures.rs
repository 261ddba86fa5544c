//! The figures of the commands as files: formats, captions beside them, and the same bytes each time.
//! How a figure is laid out is tested with the library.

use crate::support::study::Study;
use std::path::Path;

fn read(folder: &Path, name: &str) -> Vec<u8> {
    std::fs::read(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn words(folder: &Path, name: &str) -> String {
    String::from_utf8(read(folder, name)).unwrap()
}

#[test]
fn every_format_that_is_asked_for_is_written_and_twice_the_same() {
    let study = Study::new();
    let out = study.folder.path();
    for folder in ["a", "b"] {
        let arguments =
            ["maneuver", "turning", "study.toml", "--format", "png,svg,pdf", "--width", "two", "--out", folder];
        let output = study.run(&arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    for (name, start) in [
        ("turning.png", &b"\x89PNG"[..]),
        ("turning.svg", b"<svg"),
        ("turning.pdf", b"%PDF"),
        ("turning.csv", b"panel"),
    ] {
        let bytes = read(&out.join("a"), name);
        assert!(bytes.starts_with(start), "{name}");
        assert_eq!(bytes, read(&out.join("b"), name), "{name}");
    }
    // 183 mm at 192 px an inch, which a browser shows at half the size.
    let svg = words(&out.join("a"), "turning.svg");
    let width: f64 = svg.split("width=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
    assert!((width * 25.4 / 96.0 - 183.0).abs() < 1.0, "{width}");
    for measure in ["advance ", "transfer ", "tactical diameter "] {
        assert_eq!(svg.matches(measure).count(), 2, "{measure} to both sides");
    }
    let captions = words(&out.join("a"), "maneuver_turning_figures.md");
    assert!(
        captions.contains("`turning.png`, `turning.svg`, `turning.pdf`")
            && captions.contains("Advance: distance ahead"),
        "{captions}"
    );
}

#[test]
fn the_overshoots_in_the_figure_of_a_zigzag_are_those_of_the_table() {
    let study = Study::new();
    let output = study.run(&["maneuver", "zigzag", "study.toml", "--draws", "0", "--format", "svg", "--out", "z"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let folder = study.folder.path().join("z");
    assert!(!folder.join("zigzag.png").exists(), "only what is asked for");
    let document: serde_json::Value = serde_json::from_slice(&read(&folder, "maneuver_zigzag.json")).unwrap();
    let svg = words(&folder, "zigzag.svg");
    let mut count = 0;
    for trial in document["result"]["trials"].as_array().unwrap() {
        for overshoot in trial["measures"]["overshoots"].as_array().unwrap() {
            let text = format!("\n{:.1} deg\n", overshoot.as_f64().unwrap().to_degrees());
            assert!(svg.contains(&text), "{text}");
            count += 1;
        }
    }
    assert!(count >= 4, "{count}");
}

#[test]
fn every_command_with_figures_takes_formats_and_says_how_many_of_how_many_are_shown() {
    let study = Study::new();
    for (arguments, figure) in [
        (&["evaluate", "study.toml"][..], "tracks"),
        (&["simulate", "study.toml"], "tracks"),
        (&["fit", "study.toml"], "curves"),
        (&["maneuver", "stopping", "study.toml"], "stopping"),
    ] {
        let folder = arguments[..arguments.len() - 1].join("_");
        let output = study.run(&[arguments, &["--format", "svg", "--width", "one", "--out", &folder]].concat());
        assert!(output.status.code() < Some(2), "{}", String::from_utf8_lossy(&output.stderr));
        let folder_path = study.folder.path().join(&folder);
        assert!(words(&folder_path, &format!("{figure}.svg")).starts_with("<svg"), "{folder}");
        let captions = words(&folder_path, &format!("{folder}_figures.md"));
        assert!(captions.contains(&format!("## {figure}: ")), "{captions}");
        if figure == "tracks" {
            assert!(
                captions.contains(" of 4 test trajectories: ") || captions.contains(" of 8 windows, "),
                "{captions}"
            );
        }
    }
    let refused = study.run(&["simulate", "study.toml", "--format", "bmp", "--out", "x"]);
    assert_eq!(refused.status.code(), Some(2));
}
