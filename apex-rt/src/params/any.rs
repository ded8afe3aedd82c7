use super::{ParamInfo, ParamVisitor, Parameters};

/// Parameters of a program, whatever its type: what uses them is compiled once for all programs.
pub trait AnyParams {
    /// Returns [`Parameters::PARAMS`].
    fn list(&self) -> &'static [ParamInfo];

    /// Passes the parameters to `visitor`, as [`Parameters::visit_params`] does.
    fn visit(&mut self, visitor: &mut dyn ParamVisitor);
}

impl<P: Parameters> AnyParams for P {
    fn list(&self) -> &'static [ParamInfo] {
        P::PARAMS
    }

    fn visit(&mut self, visitor: &mut dyn ParamVisitor) {
        self.visit_params(visitor);
    }
}
