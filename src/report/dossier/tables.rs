//! What is in each section of a dossier: sentences and tables, their numbers read from the document.
//! Which section comes when, and what is missing in it, is decided by the page.

use super::reader::Digits::{Decimals, Significant};
use super::reader::{Digits, Reader, human, table};
use crate::numerals::DASH;
use maud::{Markup, html};

/// Statement, intended use, conditions.
pub(super) fn claim(c: &Reader) -> Markup {
    html! {
        p { (c.at("statement").text()) }
        @if c.at("intended_use").is_there() { p { "Intended use, as the user states it: " (c.at("intended_use").text()) } }
        (spans(&format!("Conditions that the {} runs visit.", c.at("conditions_of").text()), &c.at("conditions")))
    }
}

/// Quantities with their smallest and largest value.
fn spans(caption: &str, list: &Reader) -> Markup {
    let row = |s: &Reader| {
        let (factor, unit) = human(s.at("unit").text());
        let number = |key: &str| s.at(key).number(factor, Significant(3));
        vec![html! { (s.at("name").text()) }, html! { (unit) }, number("low"), number("high")]
    };
    table(caption, &["quantity", "unit", "from", "to"], 2, list.entries().iter().map(row).collect())
}

/// Particulars, sampling, channels, noise, doubts.
pub(super) fn ship(s: &Reader) -> Markup {
    let particular = |p: &Reader| {
        let (factor, unit) = human(p.at("unit").text());
        vec![html! { (p.at("name").text()) }, html! { (unit) }, p.at("value").number(factor, Significant(4))]
    };
    let particulars = s.at("particulars").entries().iter().map(particular).collect();
    let r = s.at("recorded");
    html! {
        p { (s.at("name").text()) "." @if s.at("source").is_there() { " Source of the particulars: " (s.at("source").text()) "." } }
        (table("Particulars.", &["particular", "unit", "value"], 2, particulars))
        p {
            (r.at("recordings").count()) " recordings in " (r.at("sessions").count()) " sessions, " (r.at("rows").count()) " rows, "
            (r.at("duration").number(1.0 / 3600.0, Significant(3))) " h. Runs or windows: "
            @for (i, (w, word)) in r.at("windows").entries().iter().zip(["to train", "to test"]).enumerate() {
                @if i > 0 { ", " } (w.count()) " " (word)
            }
            " (" (r.at("split").text()) ")."
        }
        (spans("Sample periods and clocks over the recordings.", &r.at("clocks")))
        (channels(&s.at("channels")))
        (noise(&s.at("noise")))
        (doubts(&s.at("doubts")))
    }
}

fn channels(list: &Reader) -> Markup {
    let row = |c: &Reader| {
        let (factor, unit) = human(c.at("unit").text());
        let units: Vec<&str> = c.at("recorded_in").entries().iter().map(Reader::text).collect();
        vec![
            html! { (c.at("channel").text()) },
            html! { (units.join(", ")) },
            html! { (unit) },
            c.at("min").number(factor, Significant(3)),
            c.at("max").number(factor, Significant(3)),
            c.at("recordings").count(),
            c.at("derived").count(),
            c.at("missing").count(),
        ]
    };
    let header =
        ["channel", "recorded in", "unit here", "smallest", "largest", "recordings", "derived in", "rows missing"];
    table("Channels; a derived channel is computed from others.", &header, 3, list.entries().iter().map(row).collect())
}

/// Noise of the sensors.
fn noise(list: &Reader) -> Markup {
    let sensors = [("position", "m"), ("heading", "rad"), ("speed", "m/s"), ("yaw rate", "rad/s")];
    let row = |(n, (name, unit)): (&Reader, (&str, &str))| {
        let (factor, unit) = human(unit);
        let number = |key: &str, factor: f64| n.at(key).number(factor, Significant(2));
        vec![
            html! { (name) },
            html! { (unit) },
            number("white", factor),
            number("coloured", factor),
            number("time", 1.0),
        ]
    };
    let rows: Vec<Vec<Markup>> = list.entries().iter().zip(sensors).map(row).collect();
    let header = ["sensor", "unit", "white", "coloured", "correlation time [s]"];
    html! {
        @if !rows.is_empty() { (table("Noise of the sensors as the diagnosis estimates it, standard deviations.", &header, 2, rows)) }
    }
}

fn doubts(list: &Reader) -> Markup {
    let row = |t: &Reader| {
        let cell = |key: &str| html! { (t.at(key).text()) };
        vec![cell("severity"), cell("fault"), cell("text"), t.at("recordings").count()]
    };
    let rows: Vec<Vec<Markup>> = list.entries().iter().map(row).collect();
    html! {
        @if rows.is_empty() { p { "The audit of the recordings has no error and no warning." } }
        @else { (table("Errors and warnings of the audit, the first of each kind in words.", &["severity", "fault", "in words", "recordings"], 3, rows)) }
    }
}

/// Command, version, build, seeds, files.
pub(super) fn inputs(i: &Reader) -> Markup {
    let row = |f: &Reader| {
        let sum = f.at("sha256");
        vec![
            html! { (f.at("path").text()) },
            html! { span.digest { @if sum.is_there() { (sum.text()) } @else { (DASH) } } },
        ]
    };
    let files = i.at("files").entries();
    let (build, seeds) = (i.at("build"), i.at("seeds"));
    html! {
        @if i.at("command").is_there() { p { code { (i.at("command").text()) } } }
        p {
            "trimtab " (i.at("version").text()) " for " (build.at("target").text()) ", " (build.at("profile").text()) " build, processor "
            (build.at("processor").text()) ". "
            @if build.at("executable_sha256").is_there() {
                "SHA-256 of the program: " span.digest { (build.at("executable_sha256").text()) }
            }
        }
        p {
            "Seeds: bootstrap " (seeds.at("bootstrap").count()) ", manoeuvres " (seeds.at("manoeuvres").count())
            @if seeds.at("diagnosis").is_there() { ", diagnosis " (seeds.at("diagnosis").count()) } "."
        }
        details {
            summary { "Files with checksums" }
            (table("", &["file", "SHA-256"], 2, files.iter().map(row).collect()))
        }
    }
}

/// Terms with their ranges, parameters.
pub(super) fn model(m: &Reader) -> Markup {
    let parameter = |p: &Reader| {
        let unit = p.at("unit").text();
        vec![
            html! { (p.at("name").text()) },
            html! { @if unit != "-" { (unit) } },
            html! { @if p.at("free").holds() { "yes" } @else { "no" } },
            p.at("value").number(1.0, Significant(4)),
            html! { @if p.at("error").float() == Some(0.0) { "fixed" } @else { (p.at("error").number(1.0, Significant(2))) } },
        ]
    };
    let parameters: Vec<Vec<Markup>> = m.at("parameters").entries().iter().map(parameter).collect();
    let v = m.at("validity");
    let covariance = m.at("covariance");
    html! {
        p {
            "Model \"" (m.at("name").text()) "\", form " (m.at("form").text()) ". "
            (v.at("share_outside").number(100.0, Significant(3))) " % of " (v.at("samples").count())
            " recorded samples lie outside the range of at least one term."
        }
        (ranges(&m.at("terms")))
        @for t in m.at("terms").entries() { (term(&t)) }
        @if !parameters.is_empty() {
            (table("Free parameters, and those with a standard error; one that ends at a bound or a constraint is fixed there.", &["parameter", "unit", "free", "value", "standard error"], 3, parameters))
        }
        @if covariance.is_there() { p { "Standard errors: " (covariance.text()) "." } }
    }
}

/// Every range beside what the recordings visit.
fn ranges(terms: &Reader) -> Markup {
    let row = |term: &Reader, v: &Reader| {
        let (words, factor, unit) = quantity(v.at("quantity").text());
        let ends = |key: &str| {
            let entries = v.at(key).entries();
            let end = |i: usize| entries.get(i).map_or_else(|| html! { (DASH) }, |e| e.number(factor, Significant(3)));
            let is_number = |i: usize| entries.get(i).is_some_and(|e| e.float().is_some());
            if is_number(0) || is_number(1) {
                html! { (end(0)) " to " (end(1)) }
            } else {
                html! { (DASH) }
            }
        };
        let share = v.at("share_outside");
        vec![
            html! { (term.at("name").text()) },
            html! { (words) @if !unit.is_empty() { " [" (unit) "]" } },
            ends("range"),
            ends("visited"),
            html! { (share.number(100.0, Decimals(1))) " %" },
        ]
    };
    let terms = terms.entries();
    let rows =
        terms.iter().flat_map(|t| t.at("ranges").entries().iter().map(|v| row(t, v)).collect::<Vec<_>>()).collect();
    let caption = "Range of validity of each term beside the range that the recordings visit; a dash is an open end, or a value that is \
                   infinite (deep water) or never known.";
    table(caption, &["term", "quantity", "valid", "visited", "outside"], 2, rows)
}

/// Words, factor and unit of a quantity of validity by its name in JSON.
fn quantity(name: &str) -> (&'static str, f64, &'static str) {
    const DEGREES: f64 = 180.0 / std::f64::consts::PI;
    match name {
        "froude" => ("Froude number", 1.0, ""),
        "drift" => ("drift angle", DEGREES, "deg"),
        "turn" => ("yaw rate r L/U", 1.0, ""),
        "depth" => ("depth over draught", 1.0, ""),
        "rate" => ("propeller rate", 1.0, "1/s"),
        "advance" => ("advance ratio ahead", 1.0, ""),
        "reversing" => ("advance ratio astern", 1.0, ""),
        "attack" => ("angle of attack", DEGREES, "deg"),
        _ => ("", 1.0, ""),
    }
}

fn term(t: &Reader) -> Markup {
    html! {
        details {
            summary { (t.at("name").text()) ": " (t.at("title").text()) }
            p { code { (t.at("equation").text()) } }
            p.subject { "Source: " (t.at("source").text()) ". Range: " (t.at("range_source").text()) "." }
        }
    }
}

/// The checks with their limits.
pub(super) fn verification(v: &Reader) -> Markup {
    let row = |c: &Reader| {
        let unit = if c.at("unit").text() == "-" { "" } else { c.at("unit").text() };
        let sign = if c.at("at").text() == "most" { "≤ " } else { "≥ " };
        let (word, class) = if c.at("passed").holds() { ("passed", "confirmed") } else { ("failed", "suspected") };
        vec![
            html! { (c.at("key").text()) },
            html! { (c.at("what").text()) },
            html! { span class={ "grade " (class) } { (word) } },
            html! { (c.at("number").number(1.0, Significant(3))) " " (unit) },
            html! { (sign) (c.at("limit").number(1.0, Significant(3))) " " (unit) },
            c.at("runs").count(),
        ]
    };
    let header = ["check", "what was computed", "", "number", "limit", "runs"];
    let rows = v.at("checks").entries().iter().map(row).collect();
    html! {
        p { "Computed on this study's model and inputs, on the test runs, or the training runs where there are none; derivatives on the \
             training runs." }
        (table("", &header, 3, rows))
    }
}

/// Errors on test runs, by group and run, and the standard manoeuvres.
pub(super) fn validation(v: &Reader) -> Markup {
    let t = v.at("test");
    let trials = v.at("manoeuvres");
    html! {
        @if t.is_there() {
            p {
                "Model `" (v.at("model").text()) "` against the baseline `" (v.at("baseline").text()) "` on " (t.at("runs").count())
                " test runs (" (t.at("trajectories").count()) " trajectories). All intervals are of 95 % and over runs: of an improvement by Student's t, else from a bootstrap ("
                (v.at("resamples").count()) " resamples, seed " (v.at("seed").count()) "). Better than the baseline on "
                (t.at("runs_better").count()) " runs, worse on " (t.at("runs_worse").count()) "; diverged on "
                (t.at("diverged_fitted").count()) " trajectories."
            }
            (errors(&t))
            (groups(&v.at("groups")))
            (runs(&v.at("runs")))
        }
        @if trials.is_there() { (manoeuvres(&trials)) }
    }
}

/// Name, SI unit and key of what is deviated in.
const CHANNELS: [(&str, &str, &str); 6] = [
    ("position north", "m", "x"),
    ("position east", "m", "y"),
    ("heading", "rad", "psi"),
    ("surge speed", "m/s", "u"),
    ("sway speed", "m/s", "v"),
    ("yaw rate", "rad/s", "r"),
];

fn errors(t: &Reader) -> Markup {
    let row = |(name, unit, key): (&str, &str, &str)| {
        let (factor, unit) = human(unit);
        let cell = |kind: &str, factor: f64| t.path(&[kind, key]).estimate(factor, Significant(3));
        vec![
            html! { "mean deviation, " (name) },
            html! { (unit) },
            cell("md_fitted", factor),
            cell("md_baseline", factor),
            cell("md_improvement", 100.0),
        ]
    };
    let cvdm = |key: &str, factor: f64| t.at(key).estimate(factor, Significant(3));
    let mut rows: Vec<Vec<Markup>> =
        CHANNELS.into_iter().filter(|c| t.path(&["md_fitted", c.2]).is_there()).map(row).collect();
    rows.push(vec![
        html! { "cVDM, all channels in one number" },
        html! { "%" },
        cvdm("cvdm_fitted", 1.0),
        cvdm("cvdm_baseline", 1.0),
        cvdm("cvdm_improvement", 100.0),
    ]);
    table("Errors on the test runs.", &["measure", "unit", "model", "baseline", "improvement [%]"], 2, rows)
}

fn groups(list: &Reader) -> Markup {
    let row = |g: &Reader| {
        let mean = |key: &str, factor: f64| g.path(&["md_fitted", key, "value"]).number(factor, Significant(3));
        vec![
            html! { (g.at("group").text()) },
            g.at("runs").count(),
            mean("x", 1.0),
            mean("y", 1.0),
            mean("psi", 1f64.to_degrees()),
            mean("u", 1.0),
            g.at("cvdm_fitted").estimate(1.0, Significant(3)),
        ]
    };
    let header = ["group", "runs", "x [m]", "y [m]", "heading [deg]", "speed [m/s]", "cVDM [%]"];
    let rows: Vec<Vec<Markup>> = list.entries().iter().map(row).collect();
    html! { @if !rows.is_empty() { (table("Mean deviations of the model by group.", &header, 1, rows)) } }
}

fn runs(list: &Reader) -> Markup {
    let row = |r: &Reader| {
        let of = |key: &str, factor: f64| r.path(&["fitted", "md", key]).number(factor, Significant(3));
        let cvdm = |which: &str| r.path(&[which, "cvdm"]).number(1.0, Significant(3));
        vec![
            html! { (r.at("run").text()) },
            html! { (r.at("manoeuvre").text()) },
            r.at("start_time").number(1.0, Decimals(0)),
            r.at("duration").number(1.0, Decimals(0)),
            of("x", 1.0),
            of("y", 1.0),
            of("psi", 1f64.to_degrees()),
            of("u", 1.0),
            cvdm("fitted"),
            cvdm("baseline"),
        ]
    };
    let header = [
        "run",
        "manoeuvre",
        "from [s]",
        "length [s]",
        "x [m]",
        "y [m]",
        "heading [deg]",
        "speed [m/s]",
        "cVDM [%]",
        "baseline [%]",
    ];
    let rows = list.entries().iter().map(row).collect();
    html! {
        details {
            summary { "Test runs one by one" }
            (table("Mean deviations; a dash where the simulation diverged or the channel was not measured.", &header, 2, rows))
        }
    }
}

/// Key, name, unit, and factor from SI of the measures of a turning circle; 0 for ship lengths.
const TURNING: [(&[&str], &str, &str, f64); 6] = [
    (&["advance"], "advance", "L", 0.0),
    (&["transfer"], "transfer", "L", 0.0),
    (&["tactical_diameter"], "tactical diameter", "L", 0.0),
    (&["steady", "diameter"], "steady diameter", "L", 0.0),
    (&["steady", "speed_loss"], "speed loss", "%", 100.0),
    (&["time_180"], "time to 180 deg", "s", 1.0),
];

fn manoeuvres(t: &Reader) -> Markup {
    let a = t.at("approach");
    let terms: Vec<&str> = t.at("left_out").entries().iter().map(Reader::text).collect();
    html! {
        h3 { "Standard manoeuvres" }
        p {
            "Simulated in calm, deep water" @if !terms.is_empty() { ", without " (terms.join(", ")) } "; approach at "
            (a.at("speed").number(1.0, Significant(4))) " m/s with " (a.at("n").number(60.0, Significant(4))) " rpm, rudder rate "
            (a.at("rudder_rate").number(1f64.to_degrees(), Significant(3))) " deg/s; L = " (t.at("length").number(1.0, Significant(4)))
            " m. Intervals are 95 % intervals of " (t.at("draws").count()) " draws of the parameters, seed " (t.at("seed").count()) "."
        }
        (trials("Turning circles.", &t.at("turning"), |m, i| TURNING.iter().map(|(keys, name, unit, factor)| {
            let key = if keys.len() > 1 && keys[1] == "diameter" { "steady_diameter" } else { keys[keys.len() - 1] };
            let factor = if *factor == 0.0 { length(t) } else { *factor };
            (format!("{name} [{unit}]"), measure(&m.path(keys), &i.at(key), factor, if *unit == "s" || *unit == "%" { Decimals(1) } else { Decimals(2) }))
        }).collect()))
        (trials("Zigzags.", &t.at("zigzag"), |m, i| zigzag(m, i, length(t))))
        (criteria(t))
    }
}

/// The factor from metres to ship lengths.
fn length(t: &Reader) -> f64 {
    t.at("length").float().map_or(f64::NAN, |l| 1.0 / l)
}

fn zigzag(m: &Reader, i: &Reader, length: f64) -> Vec<(String, Markup)> {
    let overshoots = m.at("overshoots").entries();
    let mut all: Vec<(String, Markup)> = (0..2)
        .map(|k| {
            let name = format!("overshoot_{}", k + 1);
            let value = overshoots
                .get(k)
                .map_or_else(|| html! { "not reached" }, |o| measure(o, &i.at(&name), 1f64.to_degrees(), Decimals(1)));
            (format!("overshoot {} [deg]", k + 1), value)
        })
        .collect();
    all.push((
        "initial turning [L]".into(),
        measure(&m.at("initial_turning"), &i.at("initial_turning"), length, Decimals(2)),
    ));
    all.push(("period [s]".into(), measure(&m.at("period"), &i.at("period"), 1.0, Decimals(1))));
    all
}

/// A measure with its interval.
fn measure(value: &Reader, interval: &Reader, factor: f64, digits: Digits) -> Markup {
    if !value.is_there() {
        return html! { "not reached" };
    }
    html! { (value.number(factor, digits)) " " (interval.interval(factor, digits)) }
}

/// A table with a row a measure and a column a trial.
fn trials(caption: &str, list: &Reader, of: impl Fn(&Reader, &Reader) -> Vec<(String, Markup)>) -> Markup {
    let all = list.entries();
    let columns: Vec<Vec<(String, Markup)>> = all.iter().map(|t| of(&t.at("measures"), &t.at("intervals"))).collect();
    let names: Vec<&str> = all.iter().map(|t| t.at("name").text()).collect();
    let header: Vec<&str> = std::iter::once("measure").chain(names).collect();
    let rows = (0..columns.first().map_or(0, Vec::len)).map(|k| {
        let first = html! { (columns[0][k].0) };
        std::iter::once(first).chain(columns.iter().map(|c| c[k].1.clone())).collect()
    });
    table(caption, &header, 1, rows.collect())
}

/// The criteria of IMO MSC.137(76).
fn criteria(t: &Reader) -> Markup {
    let all = [t.at("turning").entries(), t.at("zigzag").entries()].concat();
    let row = |trial: &Reader, c: &Reader| {
        let verdict = c.at("verdict").text().replace('_', " ");
        vec![
            html! { (trial.at("name").text()) },
            html! { (c.at("name").text()) },
            html! { (verdict) @if !c.at("binding").holds() { " (not binding)" } },
            html! { (c.at("unit").text()) },
            c.at("measured").number(1.0, Decimals(2)),
            c.at("limit").number(1.0, Decimals(2)),
        ]
    };
    let rows =
        all.iter().flat_map(|t| t.at("criteria").entries().iter().map(|c| row(t, c)).collect::<Vec<_>>()).collect();
    let caption =
        "Criteria of IMO MSC.137(76), by the values without their intervals; they bind ships of 100 m and more.";
    table(caption, &["trial", "criterion", "verdict", "unit", "simulated", "limit"], 4, rows)
}

/// False alarms, found again, covered.
pub(super) fn error_rates(e: &Reader) -> Markup {
    let kinds = [
        ("false_alarms", "something named in simulated studies in which nothing is missing"),
        ("found_again", "the first finding found again in simulated studies that have it"),
        ("covered", "its 95 % intervals that contain the simulated value"),
    ];
    let row = |(key, words): (&str, &str)| {
        let s = e.at(key);
        let share = |key: &str| s.at(key).number(100.0, Decimals(0));
        vec![
            html! { (words) },
            s.at("hits").count(),
            s.at("of").count(),
            html! { "[" (share("low")) ", " (share("high")) "]" },
        ]
    };
    let rows: Vec<Vec<Markup>> = kinds.into_iter().filter(|(key, _)| e.at(key).is_there()).map(row).collect();
    html! {
        @if rows.is_empty() { p { "Not measured." } }
        @else {
            (table("", &["in simulated studies with this study's inputs and noise", "cases", "of", "95 % interval of the share [%]"], 1, rows))
            p.subject { "Seed " (e.at("seed").count()) "." }
        }
    }
}

/// Verdict, and causes by what became of them.
pub(super) fn causes(c: &Reader) -> Markup {
    let settings = c.at("settings");
    let excluded = |e: &Reader| {
        let (factor, unit) = human(e.at("unit").text());
        vec![html! { (e.at("title").text()) }, html! { (unit) }, e.at("size").number(factor, Significant(3))]
    };
    let open = |o: &Reader| vec![html! { (o.at("title").text()) }, html! { (o.at("why").text()) }];
    let (excluded, open): (Vec<Vec<Markup>>, Vec<Vec<Markup>>) = (
        c.at("excluded").entries().iter().map(excluded).collect(),
        c.at("not_excluded").entries().iter().map(open).collect(),
    );
    html! {
        @if c.is_there() {
            p { strong { (c.at("headline").text()) } }
            p.subject {
                "Diagnosis: " (c.at("source").text()) "; chance of naming anything when nothing is missing "
                (settings.at("alpha").number(1.0, Significant(2))) ", seed " (settings.at("seed").count()) "."
            }
            (findings("Found", &c.at("found"), "No cause is named."))
            (findings("Refuted by test runs", &c.at("refuted"), "None that was selected is refuted by test runs."))
            (findings("Selected, and not named for another reason", &c.at("not_named"), "None."))
            h3 { "Would have been seen, and was not" }
            (table("Smallest sizes that are seen in such recordings with a probability of 80 %; smaller effects are not excluded.",
                &["cause", "unit", "from"], 2, excluded))
            h3 { "Not excluded" }
            @if open.is_empty() { p { "Every cause in the catalogue is either named, refuted, or excluded from a size on." } }
            @else { (table("", &["cause", "why"], 2, open)) }
            p {
                "Forces of general form that are left: with port-starboard symmetry p = "
                (c.path(&["left", "symmetric"]).number(1.0, Significant(2))) ", without it p = "
                (c.path(&["left", "asymmetric"]).number(1.0, Significant(2))) "."
            }
            @if c.at("stability").is_there() {
                p { "The same answer in " (c.path(&["stability", "same"]).count()) " of " (c.path(&["stability", "of"]).count())
                    " repetitions of the analysis on changed recordings." }
            }
        }
    }
}

fn findings(heading: &str, list: &Reader, none: &str) -> Markup {
    let all = list.entries();
    let row = |f: &Reader| {
        let h = f.at("held_out");
        let gain = |key: &str| h.at(key);
        let whole = |value: &str, interval: &str| {
            html! { (gain(value).number(1.0, Decimals(0))) " " (gain(interval).interval(1.0, Decimals(0))) }
        };
        vec![
            html! { (f.at("title").text()) },
            html! { (f.at("grade").text().replace('_', " ")) },
            html! { @for p in f.at("parameters").entries() { (size(&p)) br; } },
            f.at("p").number(1.0, Significant(2)),
            html! { (gain("improvement").number(100.0, Decimals(0))) " " (gain("improvement_ci95").interval(100.0, Decimals(0))) },
            whole("log_likelihood_gain", "log_likelihood_ci95"),
            whole("agreement_gain", "agreement_ci95"),
            h.at("recordings").count(),
        ]
    };
    let header = [
        "cause",
        "grade",
        "size with 95 % interval",
        "p",
        "improvement of cVDM [%]",
        "gain in log-likelihood",
        "the same, for the kinematic consistency of their sensors",
        "unseen recordings",
    ];
    html! {
        h3 { (heading) }
        @if all.is_empty() { p { (none) } } @else { (table("", &header, 3, all.iter().map(row).collect())) }
    }
}

/// A parameter of a finding.
fn size(p: &Reader) -> Markup {
    let (factor, unit) = human(p.at("unit").text());
    html! {
        (p.at("name").text()) " " (p.at("value").number(factor, Significant(3))) " "
        (p.at("ci95").interval(factor, Significant(3))) " " (unit)
    }
}
