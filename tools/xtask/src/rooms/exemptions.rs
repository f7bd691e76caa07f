//! What does not keep the rules yet, declared: each with a reason and the issue that ends it.

/// A rule of this module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// Between rooms arrows point one way.
    Circle,
    /// A folder holds few files.
    Size,
}

/// A broken rule.
#[derive(Debug)]
pub(super) struct Finding {
    pub(super) rule: Rule,
    /// The folder in which it was found.
    pub(super) room: String,
    pub(super) text: String,
}

/// A rule that a room need not keep for now.
#[derive(Debug)]
pub(super) struct Exemption {
    pub(super) rule: Rule,
    pub(super) room: &'static str,
    pub(super) reason: &'static str,
    /// The issue that ends it.
    pub(super) issue: &'static str,
}

/// The table. An exemption that nothing needs fails the check, so the table only gets shorter.
pub(super) const EXEMPTIONS: &[Exemption] = &[
    size("shaders/src/cpu", "#10", EVALUATOR),
    size("shaders/wgsl/vtex", "#10", EVALUATOR),
];

const EVALUATOR: &str = "the evaluator is merged by concept";

const fn size(room: &'static str, issue: &'static str, reason: &'static str) -> Exemption {
    Exemption {
        rule: Rule::Size,
        room,
        reason,
        issue,
    }
}

/// The findings that no exemption covers, and the exemptions that cover none.
pub(super) fn apply(exemptions: &[Exemption], findings: Vec<Finding>) -> Vec<String> {
    let covers = |exemption: &Exemption, finding: &Finding| {
        exemption.rule == finding.rule && exemption.room == finding.room
    };
    let needless = exemptions
        .iter()
        .filter(|exemption| !findings.iter().any(|finding| covers(exemption, finding)))
        .map(|exemption| {
            let Exemption {
                rule,
                room,
                reason,
                issue,
            } = exemption;
            format!("{room}: no longer needs its exemption from {rule:?} ({issue}: {reason})")
        });
    let mut problems: Vec<String> = needless.collect();
    let open = findings.into_iter().filter(|finding| {
        let mut exemptions = exemptions.iter();
        !exemptions.any(|exemption| covers(exemption, finding))
    });
    problems.extend(open.map(|finding| finding.text));
    problems
}
