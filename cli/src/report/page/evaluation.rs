//! The section about evaluation episodes.

use maud::{Markup, html};

use super::{grouped, percent, step_time};
use crate::report::run::{EvaluationEpisode, RunContents};
use crate::report::strip::{frames, moments};
use crate::report::svg::embed;
use babybench::config::{Behavior, Compat};
use babybench::env::{BehaviorInfo, EYE_HAND_PAIRS, Info, Outcome, PartNames};
use babybench::eval::Score;

/// The counters of a single evaluation episode. Under `compat: reference` counters and lists continue from episode to episode.
#[derive(Default)]
struct EpisodeCounters {
    /// Parts that each hand touched; only new ones if lists continue.
    parts: Option<[usize; 2]>,
    /// Steps with a hand in view.
    counts: Option<[u64; 4]>,
    /// The score of this episode, if its record has one.
    score: Option<f64>,
}

/// Returns the counters of a single episode. `before` is the end of the previous one.
fn alone(evaluated: &EvaluationEpisode, before: Option<&Info>) -> EpisodeCounters {
    let (Some(first), Some(last)) = (evaluated.log.info.first(), evaluated.log.info.last()) else {
        return EpisodeCounters::default();
    };
    let steps = evaluated.log.len() as u64;
    if let (Some(start), Some(end)) = (first.behavior.touches(), last.behavior.touches()) {
        // continued lists start with those of the previous episode
        let old = before.and_then(|info| info.behavior.touches());
        let old = old.filter(|old| old.iter().zip(start).all(|(old, start)| start.starts_with(old)));
        let old = old.map_or([0; 2], |old| old.map(<[usize]>::len));
        let parts = std::array::from_fn(|hand| end[hand].len().saturating_sub(old[hand]));
        let score = Score::of_episode(last, steps).filter(|_| old == [0; 2]);
        return EpisodeCounters {
            parts: Some(parts),
            score,
            ..EpisodeCounters::default()
        };
    }
    let Some((start, end)) = first.behavior.regards().zip(last.behavior.regards()) else {
        return EpisodeCounters {
            score: Score::of_episode(last, steps),
            ..EpisodeCounters::default()
        };
    };
    // in one step a counter grows by one at most
    let follows = |old: &[u64; 4]| start.iter().zip(old).all(|(now, old)| now.wrapping_sub(*old) <= 1);
    let old = before
        .and_then(|info| info.behavior.regards())
        .filter(|_| !follows(&[0; 4]));
    let old = match old.filter(follows) {
        Some(old) => old,
        None if follows(&[0; 4]) => [0; 4],
        // what came before is not in the log
        None => start,
    };
    let counts: [u64; 4] = std::array::from_fn(|k| end[k].saturating_sub(old[k]));
    let behavior = BehaviorInfo::HandRegard { counts: counts.into() };
    EpisodeCounters {
        counts: Some(counts),
        score: behavior.score(steps),
        ..EpisodeCounters::default()
    }
}

/// Returns the counters of each episode.
fn all_alone(run: &RunContents) -> Vec<EpisodeCounters> {
    let goes_on = run.compat() == Compat::Reference;
    let mut before: Option<&EvaluationEpisode> = None;
    let each = run.evaluations.iter().map(|evaluated| {
        let last = before.replace(evaluated);
        let last = last.filter(|last| goes_on && last.episode.checked_add(1) == Some(evaluated.episode));
        alone(evaluated, last.and_then(|last| last.log.info.last()))
    });
    each.collect()
}

/// Draws the section: key frames of the best episode with a video, and a table of all.
pub(super) fn evaluation_section(run: &mut RunContents) -> Markup {
    if run.evaluations.is_empty() {
        return html! {};
    }
    let counted = all_alone(run);
    let scores = counted.iter().map(|alone| alone.score);
    let with_video = || {
        run.evaluations
            .iter()
            .zip(scores.clone())
            .filter(|(e, _)| e.video.is_some())
    };
    let best = with_video().max_by(|a, b| {
        a.1.unwrap_or(0.0)
            .total_cmp(&b.1.unwrap_or(0.0))
            .then(b.0.episode.cmp(&a.0.episode))
    });
    let mut notice = None;
    let strip = match best {
        Some((evaluated, _)) => strip(run, evaluated).unwrap_or_else(|e| {
            notice = Some(format!("Key frames of evaluation episode {}: {e}.", evaluated.episode));
            html! {}
        }),
        None => {
            notice = Some("No video yet; babybench evaluate without --no-render makes one.".to_string());
            html! {}
        }
    };
    let markup = html! {
        section {
            h2 { "Evaluation" }
            (strip)
            (evaluation_table(run, &counted))
        }
    };
    run.notices.extend(notice);
    markup
}

/// Draws key frames of a video.
fn strip(run: &RunContents, evaluated: &EvaluationEpisode) -> std::io::Result<Markup> {
    let Some(path) = &evaluated.video else {
        return Ok(html! {});
    };
    let names = run.model.as_ref().map(PartNames::new);
    let moments = moments(&evaluated.log, names.as_ref());
    let numbers: Vec<usize> = moments.iter().map(|m| m.step).collect();
    let frames = frames(path, &numbers)?;
    let panel = match run.behavior {
        Behavior::SelfTouch => "the skin",
        Behavior::HandRegard => "what both eyes see",
        _ => "the room from the side",
    };
    let seen = |step: usize, event: &str| match event {
        "" => format!("step {}: the room, MIMo from above and {panel}", step + 1),
        event => format!("step {}, {event}: the room, MIMo from above and {panel}", step + 1),
    };
    let text = |step: usize| moments.iter().find(|m| m.step == step).map_or("", |m| m.text.as_str());
    Ok(html! {
        p { "Moments of episode " (evaluated.episode) ", from " code { (path.display()) } "." }
        div.strip {
            @for (step, jpeg) in &frames {
                figure {
                    img src=(embed("jpeg", jpeg)) alt=(seen(*step, text(*step))) loading="lazy";
                    figcaption {
                        b { "step " (step + 1) } (format!(" · {:.2} s", (*step as f64 + 1.0) * step_time(run)))
                        @if !text(*step).is_empty() { br; (text(*step)) }
                    }
                }
            }
        }
    })
}

/// Describes how an episode of a task ended.
fn outcome(outcome: &Outcome) -> &'static str {
    match (outcome.is_success, outcome.is_failure) {
        (true, _) => "success",
        (_, true) => "failure",
        _ => "neither",
    }
}

/// Draws the table of all episodes.
fn evaluation_table(run: &RunContents, counted: &[EpisodeCounters]) -> Markup {
    let touch = run.behavior == Behavior::SelfTouch;
    let regard = run.behavior == Behavior::HandRegard;
    let of_task = |e: &EvaluationEpisode| e.log.info.last().is_some_and(|info| info.behavior.task().is_some());
    let task = run.evaluations.iter().any(of_task);
    html! {
        div.scroll { table {
            thead { tr {
                th { "episode" } th.number { "steps" }
                @if touch { th.number { "parts, right" } th.number { "parts, left" } }
                @if regard { @for name in EYE_HAND_PAIRS { th.number { (name.replacen("eye_", "eye, ", 1).replace('_', " ")) } } }
                @if touch || regard { th.number { "score of the episode" } }
                @if task { th.number { "return" } th { "outcome" } }
            } }
            @for (evaluated, alone) in run.evaluations.iter().zip(counted) {
                @let steps = evaluated.log.len();
                tr {
                    td { (evaluated.episode) } td.number { (grouped(steps as u64)) }
                    @if let Some(parts) = alone.parts { @for n in parts { td.number { (n) } } }
                    @if let Some(counts) = alone.counts {
                        @for n in counts { td.number { (percent(n as f64 / steps as f64)) } }
                    }
                    @if let Some(info) = evaluated.log.info.last() {
                        @if let Some(task) = info.behavior.task() {
                            td.number { (format!("{:.3}", task.episode_return)) }
                            td { (outcome(&task.outcome)) }
                        }
                    }
                    @if touch || regard { td.number { b { (alone.score.map_or("–".to_string(), |score| format!("{score:.3}"))) } } }
                }
            }
        } }
        @if touch && run.compat() == Compat::Reference && run.evaluations.len() > 1 {
            p.note {
                "Under compat: reference the lists of touched parts go on from episode to episode: the table has those that were new in "
                "each, and only the first episode's own score is known."
            }
        }
    }
}
