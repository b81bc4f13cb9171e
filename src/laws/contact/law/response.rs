//! Stiffness, damping and elastic energy of one contact of a law.

use super::Law;
use crate::base::number::{Row, Vector};
use crate::laws::contact::{Contact, Response, RollingResponse};

impl Law {
    /// Stiffnesses and damping coefficients of the normal model: none where bodies are apart.
    fn response(&self, row: &[f64], contact: &Contact) -> Response {
        if self.is_apart(contact.overlap) { Response::NONE } else { (self.normal().response)(row, contact) }
    }

    /// Elastic energy of the normal force beyond an offset of the overlap \[m\] and of the tangential and the rolling
    /// spring, where there are \[J\].
    pub fn elastic_energy(&self, row: &[f64], contact: &Contact, offset: f64, history: &[Row]) -> f64 {
        let of = |place: Option<usize>| place.and_then(|place| history.get(place).copied());
        let mut energy = self.normal_energy(row, contact, offset, history);
        if let Some(spring) = of(self.spring()).map(Vector::from) {
            let from_normal_model = self.response(row, contact).tangential_stiffness;
            let stiffness = (self.tangential().stiffness)(&row[self.places.tangential..], from_normal_model);
            energy += 0.5 * stiffness * spring.dot(spring);
        }
        energy + self.rolling_energy(row, contact, history)
    }

    /// Elastic energy of the normal force beyond an offset of the overlap \[m\] \[J\].
    pub fn normal_energy(&self, row: &[f64], contact: &Contact, offset: f64, history: &[Row]) -> f64 {
        if self.is_apart(contact.overlap) {
            return 0.0;
        }
        let own = self.history_places.normal.and_then(|place| history.get(place).copied());
        (self.normal().elastic_energy)(row, contact, offset, own.unwrap_or_default())
    }

    /// Elastic energy of the rolling spring, where there is one \[J\].
    pub fn rolling_energy(&self, row: &[f64], contact: &Contact, history: &[Row]) -> f64 {
        let Some(&torque) = self.history_places.rolling.and_then(|place| history.get(place)) else { return 0.0 };
        let response = self.response(row, contact);
        (self.rolling().elastic_energy)(&row[self.places.rolling..], contact, &response, torque)
    }

    /// Springs and dashpots against rolling and twisting.
    pub fn rolling_response(&self, row: &[f64], contact: &Contact) -> RollingResponse {
        let response = self.response(row, contact);
        (self.rolling().response)(&row[self.places.rolling..], contact, &response)
    }

    /// Tangent normal stiffness, tangential stiffness \[N/m\] and damping coefficients \[kg/s\], for the stable time step:
    /// the coefficients as the scheme makes them count.
    pub fn stiffness(&self, row: &[f64], contact: &Contact) -> Response {
        let mut response = self.response(row, contact);
        if !self.is_apart(contact.overlap) {
            response.normal_stiffness = (self.normal().tangent_stiffness)(row, contact);
        }
        response.tangential_stiffness = match self.tangential().has_spring {
            true => (self.tangential().stiffness)(&row[self.places.tangential..], response.tangential_stiffness),
            false => 0.0,
        };
        if !self.tangential().has_dashpot || !self.switches(row).damps_slip() {
            response.tangential_damping = 0.0;
        }
        let own = &row[self.places.tangential..];
        response.tangential_damping = (self.tangential().damping)(own, response.tangential_damping);
        let [normal, tangential] = self.scheme().damping_factors();
        response.normal_damping *= normal;
        response.tangential_damping *= tangential;
        response
    }
}
