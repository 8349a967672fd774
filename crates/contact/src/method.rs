//! The methods of contact.

use crate::enforcement::Contact;
use crate::exact::ExactContact;
use crate::penalty::PenaltyContact;
use std::ops::{Deref, DerefMut};

/// A method of contact. Which one it is decides on the steps that can solve it, and on whether there are springs.
#[derive(Debug)]
pub enum Method {
    /// Springs, in explicit steps.
    Penalty(Box<PenaltyContact>),
    /// Lagrange multipliers, in explicit and in implicit steps.
    Exact(Box<ExactContact>),
}

impl Deref for Method {
    type Target = dyn Contact;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Penalty(contact) => &**contact,
            Self::Exact(contact) => &**contact,
        }
    }
}

impl DerefMut for Method {
    fn deref_mut(&mut self) -> &mut Self::Target {
        match self {
            Self::Penalty(contact) => &mut **contact,
            Self::Exact(contact) => &mut **contact,
        }
    }
}

impl From<PenaltyContact> for Method {
    fn from(contact: PenaltyContact) -> Self {
        Self::Penalty(Box::new(contact))
    }
}

impl From<ExactContact> for Method {
    fn from(contact: ExactContact) -> Self {
        Self::Exact(Box::new(contact))
    }
}
