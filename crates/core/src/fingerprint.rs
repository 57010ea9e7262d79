/// A running 128-bit digest of everything that decides an image, so that merging and resuming can compare scenes.
///
/// Two FNV-1a lanes over the same bytes with different offsets; not cryptographic. Floats are hashed by their bits.
/// A part that cannot describe itself calls [`Fingerprint::opaque`]: the digest then still tells *known* differences
/// apart, and [`Fingerprint::is_opaque`] says that equality is not proof.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fingerprint {
    lanes: [u64; 2],
    opaque: bool,
}

impl Default for Fingerprint {
    fn default() -> Self {
        Self { lanes: [0xcbf2_9ce4_8422_2325, 0x6c62_272e_07bb_0142], opaque: false }
    }
}

impl Fingerprint {
    /// Bytes, as they are.
    pub fn bytes(&mut self, bytes: &[u8]) {
        for &b in bytes {
            self.lanes[0] = (self.lanes[0] ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3);
            self.lanes[1] = (self.lanes[1].rotate_left(5) ^ u64::from(b)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
    }

    /// A name or tag, with its length so that neighbours cannot run together.
    pub fn tag(&mut self, name: &str) {
        self.u64(name.len() as u64);
        self.bytes(name.as_bytes());
    }

    /// An integer.
    pub fn u64(&mut self, v: u64) {
        self.bytes(&v.to_le_bytes());
    }

    /// A float, by its bits.
    pub fn f32(&mut self, v: f32) {
        self.bytes(&v.to_bits().to_le_bytes());
    }

    /// Several floats, by their bits.
    pub fn floats(&mut self, v: &[f32]) {
        for &x in v {
            self.f32(x);
        }
    }

    /// Something that cannot be described.
    pub fn opaque(&mut self) {
        self.opaque = true;
        self.tag("opaque");
    }

    /// Whether something that went in could not describe itself.
    pub fn is_opaque(&self) -> bool {
        self.opaque
    }

    /// The digest.
    pub fn value(&self) -> u128 {
        (u128::from(self.lanes[0]) << 64) | u128::from(self.lanes[1])
    }
}
