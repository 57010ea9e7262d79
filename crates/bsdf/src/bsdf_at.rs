use crate::Bsdf;
/// A BSDF at one point, by value where it is ours, through one door where it is a user's.
pub enum BsdfAt<'a> {
    /// A user's, living as long as the scene.
    Ref(&'a dyn Bsdf),
    /// A user's, made for this point.
    Open(Box<dyn Bsdf + 'a>),
}
