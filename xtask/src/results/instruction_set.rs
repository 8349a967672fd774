//! The instruction set of this machine: results of one differ from those of another in their last bits.

/// The instruction set that the program takes on this machine (`Level::detect` of `creepage-solid`).
pub fn kernels() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if std::is_x86_feature_detected!("avx512f") {
            return "avx512";
        }
        if std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma") {
            return "avx2";
        }
    }
    if cfg!(target_arch = "aarch64") { "neon" } else { "portable" }
}
