//! The tolerances of tests for a graphics adapter, as measured for its kind.
//!
//! Each driver filters textures and places samples in its own way, so that bounds of pictures hold for the adapters on which they were
//! measured. On others such tests are ignored, with the reason.

/// A kind of adapter whose pictures have been measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adapter {
    /// Mesa's llvmpipe through Vulkan, from Mesa 22.3 on.
    Vulkan,
    /// Mesa's llvmpipe through OpenGL, where wgpu leaves the edges of cube maps unblended, from Mesa 22.3 on.
    OpenGl,
    /// A GPU of NVIDIA through Vulkan: H100, H200.
    Nvidia,
}

/// The oldest Mesa that has been measured.
const MESA: (u32, u32) = (22, 3);

/// Returns the kind of an adapter from its description, as `GpuRenderer::adapter` gives it: name, backend, kind and driver.
///
/// # Errors
/// Says that none of its kind has been measured.
pub fn measured(description: &str) -> Result<Adapter, String> {
    let has = |word: &str| description.contains(word);
    let llvmpipe = has("llvmpipe") && mesa(description).is_some_and(|version| version >= MESA);
    match description {
        _ if llvmpipe && has("(Vulkan") => Ok(Adapter::Vulkan),
        _ if llvmpipe && has("(Gl") => Ok(Adapter::OpenGl),
        _ if has("NVIDIA H") && has("(Vulkan") => Ok(Adapter::Nvidia),
        _ => Err(format!(
            "what {description} may draw has not been measured, only llvmpipe of Mesa {}.{} or later and NVIDIA's H100 and H200; \
             WGPU_ADAPTER_NAME=llvmpipe chooses it where it is installed (Debian, Ubuntu: apt install mesa-vulkan-drivers)",
            MESA.0, MESA.1
        )),
    }
}

/// Returns the version of Mesa in the description of an adapter.
fn mesa(description: &str) -> Option<(u32, u32)> {
    let version = description.split("Mesa ").nth(1)?;
    let mut numbers = version.split(|c: char| !c.is_ascii_digit()).map(str::parse);
    Some((numbers.next()?.ok()?, numbers.next()?.ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_adapter_is_known_by_name_backend_and_version() {
        let name = "llvmpipe (LLVM 15.0.6, 256 bits)";
        let vulkan = |mesa: &str| measured(&format!("{name} (Vulkan, Cpu, Mesa {mesa} (LLVM 15.0.6))"));
        assert_eq!(vulkan("22.3.6"), Ok(Adapter::Vulkan));
        assert_eq!(vulkan("25.0.7-2"), Ok(Adapter::Vulkan));
        assert!(vulkan("20.3.5").is_err_and(|reason| reason.contains("Mesa 20.3.5")));
        let gl = format!("{name} (Gl, Cpu, 4.5 (Core Profile) Mesa 22.3.6)");
        assert_eq!(measured(&gl), Ok(Adapter::OpenGl));
        let nvidia = measured("NVIDIA H200 (Vulkan, DiscreteGpu, 580.159.03)");
        assert_eq!(nvidia, Ok(Adapter::Nvidia));
        let other = measured("AMD Radeon 780M (RADV PHOENIX) (Vulkan, IntegratedGpu, Mesa 25.0.7)");
        assert!(other.is_err_and(|reason| reason.contains("AMD Radeon 780M")));
    }
}
