//! The page.

mod evaluation;
mod touch;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use self::evaluation::evaluation_section;
use self::touch::touch_section;
use super::curve::curve;
use super::gaze::Gaze;
use super::months;
use super::run::RunContents;
use super::svg::download;
use babybench::config::{Behavior, Compat, Config, Scene};
use babybench::env::{EYE_HAND_PAIRS, Info, Outcome, TaskInfo};
use babybench::eval::{Score, ScoreParts};
use babybench::mimo::Version;
use babybench::text::quoted;

const STYLE: &str = include_str!("style.css");
/// The hands: name, class, colour.
const HANDS: [(&str, &str, [f32; 3]); 2] = [
    ("right hand", "right", [0.894, 0.341, 0.18]),
    ("left hand", "left", [0.18, 0.525, 0.87]),
];

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// Formats a simulated time.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// Formats a number with thin spaces between thousands.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (k, c) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            out.push('\u{202f}');
        }
        out.push(c);
    }
    out
}

fn title(run: &RunContents) -> String {
    if let Some(task) = &run.task {
        return format!("Task {task}");
    }
    let behavior = match run.behavior {
        Behavior::SelfTouch => "Self-touch",
        Behavior::HandRegard => "Hand regard",
        Behavior::None => "MIMo",
        Behavior::Reach => return "Reaching for a ball".to_string(),
        Behavior::Standup => return "Standing up".to_string(),
        Behavior::SelfBody => return "Touching a part of the body".to_string(),
        Behavior::Catch => return "Catching a ball".to_string(),
        Behavior::RollOver => return "Rolling over".to_string(),
        Behavior::Mobile => "Moving a mobile",
        Behavior::Play => "Play",
    };
    let Some(config) = &run.config else {
        return behavior.to_string();
    };
    let place = match &config.scene {
        Scene::Crib => "in the crib".to_string(),
        Scene::Cubes => "among the cubes".to_string(),
        Scene::Base => "on the floor".to_string(),
        Scene::Mobile => "in the crib with the mobile".to_string(),
        Scene::Playroom => "in the play room".to_string(),
        Scene::Blanket => "under a blanket".to_string(),
        Scene::File(path) => format!("in {}", quoted(path)),
    };
    match config.age {
        Some(age) => format!("{behavior} {place}, at {}", months(age)),
        None => format!("{behavior} {place}"),
    }
}

/// Returns the simulated time of a step, s.
fn step_time(run: &RunContents) -> f64 {
    let skip = run.config.as_ref().map_or(1, |c| c.frame_skip);
    run.model.as_ref().map_or(0.005, |m| m.opt.timestep) * f64::from(skip)
}

/// Returns the whole page, and adds notices about parts that could not be drawn.
pub(super) fn page(run: &mut RunContents) -> String {
    let body = match run.behavior {
        Behavior::SelfTouch => touch_section(run),
        Behavior::HandRegard => gaze_section(run),
        _ => task_section(run),
    };
    let evaluation = evaluation_section(run);
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                // the page runs nothing and fetches nothing, whatever the log contains
                meta http-equiv="Content-Security-Policy"
                    content="default-src 'none'; img-src data:; style-src 'unsafe-inline'";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title(run)) " – BabyBench report" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                (header(run))
                main {
                    @if !run.notices.is_empty() {
                        aside { @for notice in &run.notices { p { (notice) } } }
                    }
                    (score_section(run))
                    (curve_section(run))
                    (body)
                    (evaluation)
                    @if let Some(config) = &run.config { (config_section(config)) }
                }
                footer { "Written by babybench " (env!("CARGO_PKG_VERSION")) }
            }
        }
    };
    markup.into_string()
}

fn header(run: &RunContents) -> Markup {
    let about = run.config.as_ref().map(|c| {
        let version = Version::label(c);
        format!(
            "MIMo {version} · {} · compat: {}",
            c.actuation_model.name().replace('_', " "),
            c.compat
        )
    });
    html! {
        header {
            p.over { "BabyBench report" }
            h1 { (title(run)) }
            // a name may contain characters that change the direction of surrounding text
            p.under { (quoted(&run.dir.display().to_string())) @if let Some(about) = about { " · " (about) } }
        }
    }
}

fn card(value: &str, what: &str) -> Markup {
    html! { div.card { b { (value) } span { (what) } } }
}

fn score_section(run: &RunContents) -> Markup {
    let Some(score) = &run.score else {
        return html! {};
    };
    let best = match (&score.parts, &run.touchables) {
        (ScoreParts::SelfTouch { .. }, Some(t)) => {
            let reachable = [0, 1].map(|hand| t.reachable(hand).len());
            Score::of_parts(reachable[0] + reachable[1])
        }
        _ => 1.0,
    };
    html! {
        section {
            h2 { "Preliminary training score" }
            div.cards {
                div.card.big {
                    b { (format!("{:.3}", score.value)) }
                    div.bar { i style=(format!("width:{:.1}%", 100.0 * (score.value / best).min(1.0))) {} }
                    span { "of " (format!("{best:.3}")) " at best" }
                }
                @if let Some(number) = score.parts_per_episode {
                    (card(&format!("{number:.1}"), "parts touched in an episode"))
                }
                (card(&grouped(score.episodes as u64), "episodes counted"))
                (card(&grouped(score.steps), "steps"))
                (card(&duration(score.steps as f64 * step_time(run)), "simulated"))
                @match &score.parts {
                    ScoreParts::SelfTouch { touched } => {
                        @for (touched, (name, ..)) in touched.each_ref().into_iter().zip(&HANDS) {
                            (card(&touched.len().to_string(), &format!("parts, {name}")))
                        }
                    }
                    ScoreParts::HandRegard { .. } => {}
                }
            }
            @if let Some(fractions) = score.fractions() { (fractions_table(&fractions.to_array())) }
        }
    }
}

/// Sums up the episodes of a task: of training, or, without that, of the evaluation.
fn task_section(run: &RunContents) -> Markup {
    let last = run.evaluations.iter().filter_map(|e| e.log.info.last());
    let records: Vec<&Info> = match run.counted() {
        [] => last.collect(),
        counted => counted.iter().collect(),
    };
    let tasks: Vec<&TaskInfo> = records.iter().filter_map(|r| r.behavior.task()).collect();
    if tasks.is_empty() {
        return html! {};
    }
    let n = tasks.len() as f64;
    let mean = tasks.iter().map(|t| t.episode_return).sum::<f64>() / n;
    let share = |which: fn(&Outcome) -> bool| {
        let number = tasks.iter().filter(|t| which(&t.outcome)).count();
        format!("{:.1} %", 100.0 * number as f64 / n)
    };
    let steps: u64 = records.iter().map(|r| r.steps).fold(0, u64::saturating_add);
    html! {
        section {
            h2 { "Returns" }
            div.cards {
                (card(&format!("{mean:.3}"), "mean return"))
                (card(&share(|o| o.is_success), "end in success"))
                (card(&share(|o| o.is_failure), "end in failure"))
                (card(&grouped(tasks.len() as u64), "episodes"))
                (card(&grouped(steps), "steps"))
                (card(&duration(steps as f64 * step_time(run)), "simulated"))
            }
            (measures_table(&tasks))
        }
    }
}

/// Lists what the task measured, as means over the episodes.
fn measures_table(tasks: &[&TaskInfo]) -> Markup {
    let names = tasks.first().map_or(&[][..], |task| task.measures.names());
    let mean = |name: &str| {
        let values = tasks.iter().filter_map(|task| task.measures.get(name));
        values.sum::<f64>() / tasks.len() as f64
    };
    html! {
        @if !names.is_empty() {
            p { "At the end of an episode, on average:" }
            table.bars {
                @for name in names {
                    tr { th { (name.replace('_', " ")) } td.number { (format!("{:.3}", mean(name))) } }
                }
            }
        }
    }
}

/// Draws the shares of the steps of the four pairs of eye and hand.
fn fractions_table(fractions: &[f64; 4]) -> Markup {
    let most = fractions.iter().fold(0.01, |m: f64, f| m.max(*f));
    html! {
        table.bars {
            @for (k, name) in EYE_HAND_PAIRS.iter().enumerate() {
                tr {
                    th { (name.replacen("eye_", "eye, ", 1).replace('_', " ")) }
                    td.wide { div.bar.(HANDS[k % 2].1) { i style=(format!("width:{:.1}%", 100.0 * fractions[k] / most)) {} } }
                    td.number { (format!("{:.2} %", 100.0 * fractions[k])) }
                }
            }
        }
    }
}

fn curve_section(run: &RunContents) -> Markup {
    let reachable = run.touchables.as_ref().map_or(31, |t| t.reachable(0).len());
    let Some(chart) = curve(run.counted(), run.baseline.as_ref(), reachable) else {
        return html! {};
    };
    let what = match run.behavior {
        Behavior::SelfTouch => "Different parts of the body that each palm has touched so far, and in single episodes.",
        Behavior::HandRegard => {
            "Share of the steps with the hand in the central field of view, mean over the last episodes."
        }
        _ => {
            "Return of each episode, the sum of its rewards, and the share of successes, as means over the last episodes."
        }
    };
    html! {
        section {
            h2 { "Learning curve" }
            p { (what) @if run.compat() == Compat::Reference { " As in the score, the first record of the log does not count." } }
            figure.chart { (chart) }
        }
    }
}

fn gaze_section(run: &mut RunContents) -> Markup {
    let compat = run.compat();
    let config = run.config.clone().unwrap_or_default();
    let gaze = run.model.as_ref().and_then(|m| Gaze::new(m, &run.evaluations, &config));
    let Some(gaze) = gaze else {
        if !run.evaluations.is_empty() {
            run.notices
                .push("There is no gaze map: the run's scene does not match the evaluation logs.".to_string());
        }
        return html! {};
    };
    html! {
        section {
            h2 { "Where the eyes saw the hands" }
            p { "In evaluation, " (grouped(gaze.steps as u64)) " steps: directions of the hands from each eye, as angles from "
                "where it looks. Dashed circle: the field of view that is scored"
                @if compat == Compat::Reference { " (under compat: reference, it lies below the gaze)" }
                ". Thin line: the border of the eye's image." }
            div.maps {
                @for (eye, name, file) in [(1, "left eye", "gaze-left-eye"), (0, "right eye", "gaze-right-eye")] {
                    @let map = gaze.map(eye);
                    figure { (map) figcaption { b { (name) } " " (download(&map, Gaze::SIZE, &HANDS.map(|(name, class, _)| (class, name)), file)) } }
                }
            }
            p.legend { @for (name, class, _) in HANDS { span.key.(class) { (name) } } }
        }
    }
}

fn config_section(config: &Config) -> Markup {
    let yaml = config.to_yaml();
    let lines = yaml
        .lines()
        .filter(|l| !l.starts_with('#'))
        .filter_map(|l| l.split_once(':'));
    html! {
        section {
            h2 { "Configuration" }
            details {
                summary { "all keys" }
                dl.config { @for (key, value) in lines { div { dt { (key.trim()) } dd { (value.trim()) } } } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(1234567), "1\u{202f}234\u{202f}567");
        assert_eq!(duration(50.0), "50.0 s");
        assert_eq!(duration(600.0), "10.0 min");
        assert_eq!(duration(36000.0), "10.0 h");
    }
}
