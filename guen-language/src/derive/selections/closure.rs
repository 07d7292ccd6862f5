//! Finds the variables that a scene keeps: the least set that contains those that are asked for and is closed under
//! "the rate of a kept variable depends on it".

use guen_symbolic::{Dependence, ExprId, Workbench};

use super::selection::StateIndex;

/// The reason why a variable is kept.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Reason {
    /// `track` names it, or there is no `track` and it is a parameter.
    Tracked,
    /// Something that this statement of the scene asks for depends on it.
    Provided(String),
    /// A function that is watched of this contact, or a force that it may have, depends on it.
    Contact(String),
    /// A switch, the function of which depends on it.
    Switch(String),
    /// A reset that changes something which is kept needs it.
    Reset(String),
    /// The rate of this variable depends on it.
    Rate(StateIndex),
    /// The variable is part of a unit quaternion with this coordinate.
    Whole(StateIndex),
}

/// The variables of a state and their rates.
pub struct StateEquations<'a> {
    /// The symbols by place; none for a variable that is held.
    pub variables: &'a [Option<ExprId>],
    /// The rates by place.
    pub rates: &'a [ExprId],
    /// The parts of the rates with contacts, by place; empty without contacts.
    pub pressed: &'a [Vec<ExprId>],
    /// Groups of coordinates that stay together.
    pub wholes: &'a [Vec<StateIndex>],
}

impl StateEquations<'_> {
    /// The least closed set with these variables and with those that some quantities depend on; by place the reason, or
    /// none for a variable that leaves. What is tracked is closed first, so that the other reasons say what came in
    /// only by what is provided.
    pub fn closure(
        &self,
        bench: &mut Workbench,
        dependence: &mut Dependence,
        tracked: &[StateIndex],
        provided: &[(Reason, ExprId)],
    ) -> Vec<Option<Reason>> {
        let mut kept: Vec<Option<Reason>> = vec![None; self.variables.len()];
        for place in tracked {
            kept[*place] = Some(Reason::Tracked);
        }
        self.close(bench, dependence, &mut kept);
        for (reason, e) in provided {
            for place in self.missing(bench, dependence, &kept, *e) {
                kept[place] = Some(reason.clone());
            }
        }
        self.close(bench, dependence, &mut kept);
        kept
    }

    /// The variables that an expression depends on and that are not kept.
    fn missing(
        &self,
        bench: &mut Workbench,
        dependence: &mut Dependence,
        kept: &[Option<Reason>],
        e: ExprId,
    ) -> Vec<StateIndex> {
        let left = (0..kept.len()).filter(|place| kept[*place].is_none());
        let on = |place: &StateIndex| self.variables[*place].is_some_and(|x| dependence.depends(bench, e, x));
        left.filter(on).collect()
    }

    fn close(&self, bench: &mut Workbench, dependence: &mut Dependence, kept: &mut [Option<Reason>]) {
        let mut looked_at = vec![false; kept.len()];
        while let Some(place) = (0..kept.len()).find(|place| kept[*place].is_some() && !looked_at[*place]) {
            looked_at[place] = true;
            for e in self.pressed.get(place).into_iter().flatten().chain([&self.rates[place]]) {
                for other in self.missing(bench, dependence, kept, *e) {
                    kept[other] = Some(Reason::Rate(place));
                }
            }
            for whole in self.wholes.iter().filter(|whole| whole.contains(&place)) {
                for other in whole {
                    kept[*other].get_or_insert(Reason::Whole(place));
                }
            }
        }
    }

    /// The variables that leave and are pure quadratures, in layers: the rates of each layer depend on what is kept
    /// and on the layers before. A variable that jumps, by a force of a contact or by a reset, is no quadrature.
    pub fn quadratures(
        &self,
        bench: &mut Workbench,
        dependence: &mut Dependence,
        kept: &[Option<Reason>],
        jumps: impl Fn(StateIndex) -> bool,
    ) -> Vec<Vec<Quadrature>> {
        let mut known: Vec<Option<Reason>> = kept.to_vec();
        let mut layers: Vec<Vec<Quadrature>> = Vec::new();
        loop {
            let places: Vec<StateIndex> = (0..known.len())
                .filter(|place| known[*place].is_none() && self.variables[*place].is_some())
                .filter(|place| !jumps(*place))
                .filter(|place| self.missing(bench, dependence, &known, self.rates[*place]).is_empty())
                .collect();
            if places.is_empty() {
                return layers;
            }
            let layer = places.iter().map(|place| {
                let needs = self.missing(bench, dependence, kept, self.rates[*place]);
                Quadrature { place: *place, needs }
            });
            layers.push(layer.collect());
            for place in places {
                known[place] = Some(Reason::Tracked);
            }
        }
    }
}

/// A variable that left and is an integral of what is known.
#[derive(Clone, Debug)]
pub struct Quadrature {
    /// The variable.
    pub place: StateIndex,
    /// The quadratures of the layers before that its rate depends on.
    pub needs: Vec<StateIndex>,
}
