//! The equations of motion of a model with its parameter values: the mass matrix inverted once, the base terms called without
//! indirection, further terms added behind them. It integrates nothing: it says how the ship accelerates.

use crate::model::{BASE, Model, Placed};
use crate::physics::{Adjust, Flow, Inertia, Instant, Mobility, Number, Physics};
use crate::state::{Force, Inputs, STATES, State};
use crate::terms::hydrodynamics::hull::Hull;
use crate::terms::hydrodynamics::resistance::Resistance;
use crate::terms::propulsion::propeller::Propeller;
use crate::terms::steering::rudder::Rudder;
use trimtab_ad::Scalar;

/// A model with values of its parameters, ready to be evaluated with any number whose coefficients are `C`.
#[derive(Clone, Debug)]
pub struct Dynamics<'m, C> {
    model: &'m Model,
    theta: Vec<C>,
    /// The inverse mass matrix where no term changes it.
    mobility: Mobility<C>,
    /// Whether there is no current, neither recorded nor from a term.
    still: bool,
}

/// What the mass matrix turns forces into.
enum Inverse<S: Scalar> {
    Constant(Mobility<S::Coefficient>),
    Varying(Mobility<S>),
}

impl<'m, C: Number<Coefficient = C>> Dynamics<'m, C> {
    /// The equations of motion of a model at the parameter values `theta`, in the order of [`Model::parameters`].
    pub fn new(model: &'m Model, theta: Vec<C>) -> Self {
        let mobility = Inertia::new(model.placed()[1].part(&theta), &Adjust::neutral()).inverse();
        Self { model, theta, mobility, still: false }
    }

    /// The same in still water: the recorded current is zero throughout, so that inflow is velocity over ground.
    #[must_use]
    pub fn in_still_water(mut self, still: bool) -> Self {
        self.still = still && self.extras().is_empty();
        self
    }

    /// Whether there is no current.
    pub fn is_still(&self) -> bool {
        self.still
    }

    /// The model.
    pub fn model(&self) -> &'m Model {
        self.model
    }

    /// The parameter values.
    pub fn theta(&self) -> &[C] {
        &self.theta
    }

    /// The terms beyond the base.
    #[inline(always)]
    pub fn extras(&self) -> &'m [Placed] {
        &self.model.placed()[BASE.len()..]
    }

    #[inline(always)]
    fn base(&self, term: usize) -> &[C] {
        self.model.placed()[term].part(&self.theta)
    }

    /// An instant of a state under inputs.
    #[inline(always)]
    pub fn instant<'a, S: Scalar<Coefficient = C>>(
        &'a self,
        state: &'a State<S>,
        inputs: &'a Inputs<C>,
    ) -> Instant<'a, S> {
        Instant::new(&self.model.ship, self.model.form, state, inputs)
    }

    /// What terms change for the others at these inputs.
    #[inline(always)]
    fn adjust(&self, inputs: &Inputs<C>) -> Adjust<C> {
        let mut adjust = Adjust::neutral();
        adjust.current = inputs.current;
        for t in self.extras() {
            C::physics(t.term).adjust(t.part(&self.theta), &self.model.ship, inputs, &mut adjust);
        }
        adjust
    }

    /// What the terms share at an instant.
    #[inline(always)]
    pub fn flow<S: Number<Coefficient = C>>(&self, at: &Instant<S>) -> Flow<S> {
        if self.still {
            return Flow::new(self.base(0), at, Adjust::neutral(), true);
        }
        Flow::new(self.base(0), at, self.adjust(at.inputs), false)
    }

    /// The terms' force together, in a flow that is known (X, Y \[N\], N \[N m\] on the body axes about midship).
    #[inline(always)]
    pub fn force<S: Number<Coefficient = C>>(&self, at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let mut force = Hull.force(self.base(1), at, flow);
        force += Resistance.force(self.base(2), at, flow);
        force += Propeller.force(self.base(3), at, flow);
        force += Rudder.force(self.base(4), at, flow);
        for t in self.extras() {
            force += S::physics(t.term).force(t.part(&self.theta), at, flow);
        }
        force
    }

    /// The inverse of the mass matrix in a flow.
    #[inline(always)]
    fn inverse<S: Number<Coefficient = C>>(&self, flow: &Flow<S>) -> Inverse<S> {
        if self.extras().is_empty() {
            Inverse::Constant(self.mobility)
        } else if flow.adjust.roll.is_none() {
            Inverse::Constant(Inertia::new(self.base(1), &flow.adjust).inverse())
        } else {
            Inverse::Varying(self.inertia(flow).inverse())
        }
    }

    /// The mass matrix in a flow, with what roll adds to it.
    pub fn inertia<S: Number<Coefficient = C>>(&self, flow: &Flow<S>) -> Inertia<S> {
        let inertia = Inertia::new(self.base(1), &flow.adjust);
        let [sway_yaw, yaw] = flow.adjust.roll.unwrap_or([C::zero(); 2]);
        let cube = flow.speed * flow.speed * flow.speed;
        Inertia {
            surge: S::lift(inertia.surge),
            sway: S::lift(inertia.sway),
            sway_yaw: cube * sway_yaw + inertia.sway_yaw,
            yaw_sway: S::lift(inertia.yaw_sway),
            yaw: cube * yaw + inertia.yaw,
        }
    }

    /// Accelerations through the water (u', v', r') under a force, in a flow that is known.
    #[inline(always)]
    pub fn accelerations<S: Number<Coefficient = C>>(&self, flow: &Flow<S>, force: &Force<S>) -> [S; 3] {
        match self.inverse(flow) {
            Inverse::Constant(mobility) => mobility.accelerations(force),
            Inverse::Varying(mobility) => mobility.accelerations(force),
        }
    }

    /// The inverse of the mass matrix in a flow of plain numbers.
    #[inline(always)]
    pub fn mobility(&self, flow: &Flow<C>) -> Mobility<C> {
        match self.inverse(flow) {
            Inverse::Constant(mobility) | Inverse::Varying(mobility) => mobility,
        }
    }

    /// Time derivative of the state \[x', y', psi', u', v', r'\], and the flow behind it.
    ///
    /// The equations are solved in the water frame, where a uniform current exerts no force, and the velocities over ground
    /// follow from `u' = u_r' + v_c r`, `v' = v_r' - u_c r`. `push` is a force added to that of the terms
    /// (X, Y \[N\], N \[N m\]).
    pub fn rates<S: Number<Coefficient = C>>(
        &self,
        state: &State<S>,
        inputs: &Inputs<C>,
        push: &Force<S>,
    ) -> ([S; STATES], Flow<S>) {
        self.rates_in_place(state, inputs, push)
    }

    /// [`Self::rates`] without a call, for the one place where the flow's copy would cost more than the code.
    #[inline(always)]
    pub(crate) fn rates_in_place<S: Number<Coefficient = C>>(
        &self,
        state: &State<S>,
        inputs: &Inputs<C>,
        push: &Force<S>,
    ) -> ([S; STATES], Flow<S>) {
        let at = self.instant(state, inputs);
        let flow = self.flow(&at);
        let force = self.force(&at, &flow) + *push;
        let [mut du, mut dv, dr] = self.accelerations(&flow, &force);
        if !self.still {
            du += flow.current[1] * state.r;
            dv -= flow.current[0] * state.r;
        }
        let [sin, cos] = at.heading;
        let rates = [state.u * cos - state.v * sin, state.u * sin + state.v * cos, state.r, du, dv, dr];
        (rates, flow)
    }

    /// The force of each term by name at an instant (X, Y \[N\], N \[N m\]).
    pub fn contributions(&self, state: &State<C>, inputs: &Inputs<C>) -> Vec<(&'static str, Force<C>)> {
        let at = self.instant(state, inputs);
        let flow = self.flow(&at);
        let force = |t: &Placed| (t.term.info().name, C::physics(t.term).force(t.part(&self.theta), &at, &flow));
        self.model.placed().iter().map(force).collect()
    }

    /// What the sensors report of a state whose rates are known: the state, changed by the sensor terms. Where u and v were made from a velocity
    /// over ground and the reported heading, they are turned by the error e of that heading: `u cos e + v sin e`, `v cos e - u sin e`.
    pub fn measure<S: Number<Coefficient = C>>(
        &self,
        state: &State<S>,
        inputs: &Inputs<C>,
        rates: &[S; STATES],
        flow: &Flow<S>,
    ) -> [S; STATES] {
        let at = self.instant(state, inputs);
        let mut y = state.to_array();
        for t in self.extras() {
            S::physics(t.term).measure(t.part(&self.theta), &at, flow, rates, &mut y);
        }
        if self.model.ship.velocity_by_heading {
            let (sin, cos) = (y[2] - state.psi).sin_cos();
            (y[3], y[4]) = (y[3] * cos + y[4] * sin, y[4] * cos - y[3] * sin);
        }
        y
    }

    /// What the sensors report of a state.
    pub fn report<S: Number<Coefficient = C>>(&self, state: &[S; STATES], inputs: &Inputs<C>) -> [S; STATES] {
        let state = State::from_array(*state);
        let (rates, flow) = self.rates(&state, inputs, &Force::zero());
        self.measure(&state, inputs, &rates, &flow)
    }

    /// Passes a run's inputs through the terms that change them (actuator lag, rudder offset); `dt` is their period \[s\].
    pub fn drive(&self, dt: f64, series: &mut [Inputs<C>]) {
        for t in self.extras() {
            C::physics(t.term).drive(t.part(&self.theta), &self.model.ship, dt, series);
        }
    }
}
