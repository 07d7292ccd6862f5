//! The words of a contact: which kind they make it, and which belong together.

use super::*;

impl<'a> Resolver<'a, '_> {
    /// The clause that says what kind of contact it is.
    pub(super) fn kind(&mut self, contact: &'a Contact) -> Evaluated<&'a Clause> {
        let kinds: Vec<&Clause> = contact.clauses.iter().filter(|clause| clause.word.is_kind()).collect();
        match kinds[..] {
            [kind] => Ok(kind),
            [] => {
                let fault = Fault::new(contact.name.span(), format!("contact `{}` has no gap", contact.name));
                self.eval.fail(
                    fault
                        .help("write `gap = e`, the distance that stays nonnegative")
                        .help("a velocity that a force holds at zero is a `grip = v`, a lock a `latch = e`"),
                )
            }
            [first, second, ..] => {
                let (one, other) = (first.word.text(), second.word.text());
                let fault =
                    Fault::new(second.keyword, format!("`{}` has a `{one}` and a `{other}`", contact.name));
                self.eval.fail(fault.help("declare two contacts"))
            }
        }
    }

    /// The words that belong together.
    pub(super) fn words(&mut self, contact: &Contact, kind: &Clause) {
        let name = &contact.name;
        let has = |word: ClauseWord| contact.clause(word).is_some();
        let mut report = |fault: Fault| {
            self.eval.faults.report(fault);
        };
        for clause in contact.clauses.iter().filter(|clause| !clause.word.is_kind()) {
            let word = clause.word;
            let fault = match (kind.word, word) {
                (ClauseWord::Gap, ClauseWord::Limit) => {
                    Some(Fault::new(clause.keyword, "`limit` belongs to a grip").help(
                        "friction of a contact is limited by `friction = mu` and the contact's own force",
                    ))
                }
                (ClauseWord::Gap, ClauseWord::Load) => {
                    Some(Fault::new(clause.keyword, "`load` belongs to a grip, a contact has its own"))
                }
                (ClauseWord::Gap | ClauseWord::Grip, ClauseWord::Release) => {
                    Some(Fault::new(clause.keyword, "`release` belongs to a latch"))
                }
                (ClauseWord::Grip, ClauseWord::Restitution) => {
                    Some(Fault::new(clause.keyword, "a grip does not bounce"))
                }
                (ClauseWord::Latch, ClauseWord::Restitution) => {
                    Some(Fault::new(clause.keyword, "a latch does not bounce"))
                }
                (ClauseWord::Grip, ClauseWord::Slip) => Some(
                    Fault::new(clause.keyword, format!("the slip of `{name}` is its grip"))
                        .help("remove this"),
                ),
                (ClauseWord::Grip, ClauseWord::When) => Some(
                    Fault::new(clause.keyword, "a grip neither opens nor closes")
                        .help("a limit that is zero lets it slip: multiply `limit` by a switch"),
                ),
                (
                    ClauseWord::Latch,
                    ClauseWord::Slip
                    | ClauseWord::Friction
                    | ClauseWord::Stiction
                    | ClauseWord::Limit
                    | ClauseWord::Load,
                ) => Some(Fault::new(clause.keyword, format!("a latch has no `{}`", word.text()))),
                (ClauseWord::Gap, ClauseWord::Friction) if !has(ClauseWord::Slip) => Some(
                    Fault::new(clause.keyword, "friction without slip")
                        .help("say along which velocity it acts: `slip = ..`"),
                ),
                (ClauseWord::Gap, ClauseWord::Stiction) if !has(ClauseWord::Slip) => Some(
                    Fault::new(clause.keyword, "stiction without slip")
                        .help("say along which velocity it acts: `slip = ..`"),
                ),
                (_, ClauseWord::Stiction) if !has(ClauseWord::Friction) => Some(
                    Fault::new(clause.keyword, "stiction without friction")
                        .help("say what holds while it slips: `friction = ..`"),
                ),
                (ClauseWord::Gap, ClauseWord::Slip)
                    if !has(ClauseWord::Friction) && !has(ClauseWord::Stiction) =>
                {
                    Some(Fault::new(
                        clause.keyword,
                        "slip without friction: say `friction = 0` if it is smooth",
                    ))
                }
                (ClauseWord::Grip, ClauseWord::Limit)
                    if has(ClauseWord::Friction) || has(ClauseWord::Load) =>
                {
                    Some(
                        Fault::new(clause.keyword, format!("`{name}` has a `limit` and a `load`"))
                            .help("a grip has one limit: `limit = F`, or `friction = mu, load = N`"),
                    )
                }
                (ClauseWord::Grip, ClauseWord::Stiction) => Some(
                    Fault::new(clause.keyword, "a grip has one limit, whether it slips or not")
                        .help("write a contact where they differ"),
                ),
                _ => None,
            };
            fault.into_iter().for_each(&mut report);
        }
        let is_limited = has(ClauseWord::Limit) || (has(ClauseWord::Friction) && has(ClauseWord::Load));
        if kind.word == ClauseWord::Grip && !is_limited {
            report(Fault::new(
                kind.keyword,
                format!("the grip `{name}` needs `limit`, or `friction` and `load`"),
            ));
        }
    }
}
