//! Radiometric quantities (helper fills).
