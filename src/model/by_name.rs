//! What a fit may do with a parameter, set by name: fixed, within bounds, with a prior; freed by [`Model::release`].
//! It fits nothing, and a model file says the same in its own words.

use super::{Model, ModelError, Prior};

impl Model {
    /// Fixes a parameter, or all of a term, at its value: a fit does not change it.
    ///
    /// # Errors
    /// No parameter and no term of the model has this name.
    pub fn hold(&mut self, name: &str) -> Result<(), ModelError> {
        let of_term = |p: &super::Parameter| p.name.split_once('.').is_some_and(|(term, _)| term == name);
        if self.parameters.iter().any(of_term) {
            self.parameters.iter_mut().filter(|p| of_term(p)).for_each(|p| p.free = false);
            return Ok(());
        }
        let i = self.find(name)?;
        self.parameters[i].free = false;
        Ok(())
    }

    /// Sets the bounds that a fit keeps a parameter within, in its own unit; infinite for none.
    ///
    /// # Errors
    /// No parameter has this name, or its value is not between the bounds.
    pub fn bound(&mut self, name: &str, lower: f64, upper: f64) -> Result<(), ModelError> {
        let i = self.find(name)?;
        let p = &mut self.parameters[i];
        if !(lower <= p.value && p.value <= upper) {
            let expected = format!(
                "its value must be within the bounds, {lower} to {upper} {}; set the value first, or give other bounds",
                p.info.unit
            );
            return Err(ModelError::BadValue {
                name: p.name.clone(),
                value: p.value,
                expected: expected.replace(" -;", ";"),
            });
        }
        (p.lower, p.upper) = (lower, upper);
        Ok(())
    }

    /// Sets what is known of a parameter before the data, or that nothing is. It neither frees nor fixes it.
    ///
    /// # Errors
    /// No parameter has this name, or the prior is not a finite mean with a standard deviation above 0.
    pub fn prior(&mut self, name: &str, prior: Option<Prior>) -> Result<(), ModelError> {
        let i = self.find(name)?;
        let p = &mut self.parameters[i];
        if let Some(prior) = prior {
            let bad = |value: f64, expected: &str| {
                Err(ModelError::BadValue { name: p.name.clone(), value, expected: expected.to_owned() })
            };
            if !prior.mean.is_finite() {
                return bad(prior.mean, "the mean of a prior must be a finite number; leave the prior out for none");
            }
            if !(prior.sd > 0.0 && prior.sd.is_finite()) {
                return bad(
                    prior.sd,
                    "the standard deviation of a prior must be above 0; leave the prior out for none",
                );
            }
        }
        p.prior = prior;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_is_fixed_bounded_and_given_a_prior_by_name_or_symbol() {
        let mut model = crate::study::demo::example().unwrap().model;
        let of = |model: &Model, name: &str| model.parameters[model.find(name).unwrap()].clone();
        model.hold("p5").unwrap();
        assert!(!of(&model, "rudder.lift1").free && of(&model, "rudder.lift0").free);
        model.hold("resistance").unwrap();
        assert_eq!(model.free().len(), 7);
        let value = of(&model, "p6").value;
        model.bound("p6", value - 1.0, value + 2.0).unwrap();
        assert_eq!((of(&model, "p6").lower, of(&model, "p6").upper), (value - 1.0, value + 2.0));
        model.prior("p6", Some(Prior { mean: 1.0, sd: 0.5 })).unwrap();
        assert_eq!(of(&model, "p6").prior, Some(Prior { mean: 1.0, sd: 0.5 }));
        model.prior("p6", None).unwrap();
        assert_eq!(of(&model, "p6").prior, None);
    }

    #[test]
    fn what_cannot_be_is_refused_and_changes_nothing() {
        let mut model = crate::study::demo::example().unwrap().model;
        let before = format!("{:?}", model.parameters);
        assert!(model.hold("rudder.lift9").unwrap_err().to_string().contains("did you mean"));
        assert!(model.bound("p6", f64::NAN, 1.0).unwrap_err().to_string().contains("within the bounds"));
        assert!(model.bound("p6", 1e6, 2e6).unwrap_err().to_string().contains("within the bounds"));
        for (mean, sd) in [(f64::NAN, 1.0), (0.0, 0.0), (0.0, f64::INFINITY)] {
            assert!(model.prior("p6", Some(Prior { mean, sd })).is_err());
        }
        assert_eq!(format!("{:?}", model.parameters), before);
    }
}
