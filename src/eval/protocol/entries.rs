//! Reads measures and published rows of a protocol's document.

use super::tree::{Entry, Fault, Fields, fault};
use super::{MeasureRule, ProtocolMeasure, PublishedRow};

/// Reads a measure.
pub(super) fn measure(entry: &Entry) -> Result<ProtocolMeasure, Fault> {
    let mut fields = entry.fields("a measure")?;
    let name = fields.need("name")?.text("name")?.to_string();
    let (label, unit, meaning) = (fields.words("label")?, fields.words("unit")?, fields.words("meaning")?);
    let measure = ProtocolMeasure {
        label: if label.is_empty() {
            name.replace('_', " ")
        } else {
            label
        },
        unit,
        decimals: match fields.get("decimals") {
            Some(entry) => entry.number("decimals")?.clamp(0.0, 9.0) as usize,
            None => 2,
        },
        meaning,
        figure: fields.words("figure")? == "true",
        rule: rule(&mut fields)?,
        name,
    };
    fields.end()?;
    Ok(measure)
}

/// Reads how a measure follows from others.
fn rule(fields: &mut Fields<'_>) -> Result<MeasureRule, Fault> {
    let line = fields.line();
    let list = |entry: Option<&Entry>, key: &str| entry.map(|entry| entry.names(key)).transpose();
    let (mean, orders) = (
        list(fields.get("mean_of"), "mean_of")?,
        list(fields.get("orders_of"), "orders_of")?,
    );
    let [ratio, reached, age] = [
        fields.words("ratio_of")?,
        fields.words("reached_by")?,
        fields.words("age_of")?,
    ];
    let (over, times) = (fields.words("over")?, fields.number("times")?);
    let (below, above) = (fields.number("below")?, fields.number("above")?);
    let mut found = Vec::new();
    found.extend(mean.map(MeasureRule::Mean));
    found.extend(orders.map(MeasureRule::Orders));
    if !ratio.is_empty() {
        let over = over.clone();
        found.push(MeasureRule::Ratio { of: ratio, over });
    }
    if !reached.is_empty() {
        let times = times.ok_or_else(|| fault(line, "`reached_by` needs `times`, a factor on the rate of `over`"))?;
        found.push(MeasureRule::Reached {
            of: reached,
            over,
            times,
        });
    }
    if !age.is_empty() {
        let (level, falls) = match (below, above) {
            (Some(level), None) => (level, true),
            (None, Some(level)) => (level, false),
            _ => {
                return Err(fault(
                    line,
                    "`age_of` needs either `below` or `above`, the level that is crossed",
                ));
            }
        };
        found.push(MeasureRule::Age { of: age, level, falls });
    }
    match found.len() {
        0 | 1 => Ok(found.pop().unwrap_or_default()),
        _ => Err(fault(line, "a measure has at most one rule")),
    }
}

/// Reads a published row.
pub(super) fn published(entry: &Entry) -> Result<PublishedRow, Fault> {
    let mut fields = entry.fields("a published row")?;
    let ages = fields.get("ages").map(|ages| ages.numbers("ages")).transpose()?;
    let word = |text: String| Some(text).filter(|text| !text.is_empty());
    let row = PublishedRow {
        says: fields.need("says")?.text("says")?.to_string(),
        measure: word(fields.words("measure")?),
        condition: word(fields.words("condition")?),
        phase: word(fields.words("phase")?),
        ages: match ages.as_deref() {
            None => None,
            Some(&[from, to]) if from <= to => Some([from, to]),
            Some(_) => {
                return Err(fault(
                    entry.line,
                    "`ages` of a published row are two: the youngest and the oldest",
                ));
            }
        },
        value: fields.number("value")?,
        low: fields.number("low")?,
        high: fields.number("high")?,
        sd: fields.number("sd")?,
        unit: fields.need("unit")?.text("unit")?.to_string(),
        source: fields.need("source")?.text("source")?.to_string(),
        mark: fields.need("mark")?.text("mark")?.to_string(),
    };
    if !PublishedRow::MARKS.iter().any(|(mark, _)| *mark == row.mark) {
        return Err(fault(
            entry.line,
            "`mark` is r (read), s (seen in a summary), m (measured), h (worked out) or u (unsourced)",
        ));
    }
    if row.source.is_empty() || row.says.is_empty() {
        return Err(fault(entry.line, "a published row has its `source` and what it `says`"));
    }
    if row.value.is_some() && (row.low.is_some() || row.high.is_some()) {
        return Err(fault(
            entry.line,
            "a published row has a `value`, or a range from `low` to `high`",
        ));
    }
    fields.end()?;
    Ok(row)
}
