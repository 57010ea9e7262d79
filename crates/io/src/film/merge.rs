use etendue_camera::MergeError;

use super::{FilmFile, FilmMergeError};

impl FilmFile {
    /// Whether `other` is another part of the same picture: the same scene, settings, size, replicates and planes,
    /// and no sample in common. Nothing is added.
    ///
    /// # Errors
    /// [`FilmMergeError`], naming both files and what differs.
    pub fn check(&self, other: &Self) -> Result<(), FilmMergeError> {
        let (a, b) = (self.name().to_owned(), other.name().to_owned());
        // The size first: it is part of the camera, but says more than "another setting".
        if let Some(source) = self.unlike(other) {
            return Err(FilmMergeError::Film { a, b, source });
        }
        let words = self.info.differences(&other.info);
        if self.info.scene.value != other.info.scene.value {
            let words = if words.is_empty() { words } else { format!(" ({words})") };
            return Err(FilmMergeError::Scene { a, b, words });
        }
        if self.info.settings.value != other.info.settings.value {
            let words = if words.is_empty() { "in a setting without a name".into() } else { words };
            return Err(FilmMergeError::Settings { a, b, words });
        }
        for mine in &self.origins {
            for theirs in &other.origins {
                if let Some(range) = mine.samples.overlap(&theirs.samples) {
                    let (a, b) = (mine.name.clone(), theirs.name.clone());
                    return Err(FilmMergeError::Overlap { a, b, range });
                }
            }
        }
        Ok(())
    }

    fn unlike(&self, other: &Self) -> Option<MergeError> {
        let (a, b) = (&self.film, &other.film);
        if a.size() != b.size() {
            return Some(MergeError::Size(a.size(), b.size()));
        }
        if a.replicates() != b.replicates() {
            return Some(MergeError::Replicates(a.replicates(), b.replicates()));
        }
        (a.planes() != b.planes()).then(|| MergeError::Planes(a.planes(), b.planes()))
    }

    /// Adds another part of the same picture. Exact: the parts of any division of the samples, merged in any order,
    /// give the bits of the undivided film.
    ///
    /// # Errors
    /// As [`FilmFile::check`].
    pub fn merge(mut self, other: &Self) -> Result<Self, FilmMergeError> {
        self.check(other)?;
        self.film.merge(&other.film).map_err(|source| FilmMergeError::Film {
            a: self.name().to_owned(),
            b: other.name().to_owned(),
            source,
        })?;
        self.info.samples.extend(&other.info.samples);
        self.info.scene.opaque |= other.info.scene.opaque;
        self.info.settings.opaque |= other.info.settings.opaque;
        self.origins.extend(other.origins.iter().cloned());
        Ok(self)
    }
}
