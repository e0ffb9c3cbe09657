//! The graphics device: its choice, and the errors it reports.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};

use super::GpuError;

/// A device with its queue, and the errors it reported.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// Name, backend and kind.
    pub name: String,
    /// Whether the adapter computes on the CPU.
    pub software: bool,
    faults: Arc<Mutex<DeviceErrors>>,
}

#[derive(Debug, Default)]
struct DeviceErrors {
    /// The first error since the last check of each thread: threads may share the device, and errors appear in the thread that
    /// caused them.
    first: HashMap<ThreadId, GpuError>,
    lost: Option<String>,
}

impl Gpu {
    /// Opens the best adapter: a GPU before software, OpenGL last among equals. `WGPU_BACKEND` and `WGPU_ADAPTER_NAME` narrow the choice.
    ///
    /// A process opens one and shares it until it is lost. This does not only save time: NVIDIA's drivers (580.159) hang when a device is
    /// closed while another thread that has used Vulkan ends, and Mesa 22.3's llvmpipe crashed the process while two devices were in use.
    #[cfg(not(target_arch = "wasm32"))]
    pub async fn open() -> Result<Self, GpuError> {
        static SHARED: Mutex<Option<(Option<String>, Gpu)>> = Mutex::new(None);
        let wanted = std::env::var("WGPU_ADAPTER_NAME").ok();
        let mut shared = lock(&SHARED);
        match &*shared {
            Some((name, gpu)) if *name == wanted && lock(&gpu.faults).lost.is_none() => Ok(gpu.clone()),
            _ => {
                // callers that need the same device wait for all of this; outside browsers it never suspends
                let gpu = pollster::block_on(Self::open_own(wanted.as_deref()))?;
                Ok(shared.insert((wanted, gpu)).1.clone())
            }
        }
    }

    /// As above. In browsers each caller gets its own.
    #[cfg(target_arch = "wasm32")]
    pub async fn open() -> Result<Self, GpuError> {
        Self::open_own(None).await
    }

    async fn open_own(wanted: Option<&str>) -> Result<Self, GpuError> {
        let (instance, backends) = instance();
        let mut tried = vec![format!("looked for {}", names(backends))];
        for adapter in adapters(&instance, backends, wanted).await {
            let name = describe(&adapter.get_info());
            match Self::from_adapter(&adapter).await {
                Ok(gpu) => return Ok(gpu),
                Err(e) => tried.push(format!("{name}: {e}")),
            }
        }
        if tried.len() == 1 {
            let none = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await;
            tried.extend(none.err().map(|e| e.to_string()));
        }
        let tried = tried.join("; ");
        Err(GpuError::NoAdapter { tried })
    }

    async fn from_adapter(adapter: &wgpu::Adapter) -> Result<Self, wgpu::RequestDeviceError> {
        let most = adapter.limits();
        let required_limits = wgpu::Limits {
            max_buffer_size: most.max_buffer_size,
            ..wgpu::Limits::downlevel_webgl2_defaults().using_resolution(most)
        };
        let description = wgpu::DeviceDescriptor {
            label: Some("babybench"),
            required_limits,
            ..Default::default()
        };
        let (device, queue) = adapter.request_device(&description).await?;
        Ok(Self::new(device, queue))
    }

    /// Wraps a device that is already open. Errors outside error scopes are reported here from now on.
    pub fn new(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let faults = Arc::new(Mutex::new(DeviceErrors::default()));
        let seen = faults.clone();
        device.on_uncaptured_error(Arc::new(move |e: wgpu::Error| {
            let error = match e {
                wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory,
                other => GpuError::Device(other.to_string()),
            };
            lock(&seen).first.entry(thread::current().id()).or_insert(error);
        }));
        let seen = faults.clone();
        device.set_device_lost_callback(move |reason, message| {
            lock(&seen).lost = Some(if message.is_empty() {
                format!("{reason:?}")
            } else {
                message
            });
        });
        let info = device.adapter_info();
        Self {
            name: describe(&info),
            software: info.device_type == wgpu::DeviceType::Cpu,
            device,
            queue,
            faults,
        }
    }

    /// Returns the first error of this thread reported since its last call; a lost device stays lost.
    pub fn check(&self) -> Result<(), GpuError> {
        let mut faults = lock(&self.faults);
        let first = faults.first.remove(&thread::current().id());
        match (&faults.lost, first) {
            (Some(message), _) => Err(GpuError::Lost(message.clone())),
            (None, Some(e)) => Err(e),
            (None, None) => Ok(()),
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the instance that opens the system's graphics drivers, and the backends that it searches.
///
/// A process has one: drivers, above all those of OpenGL, do not support being opened in one thread while they are closed in
/// another, and opening them takes most of a renderer's start time.
#[cfg(not(target_arch = "wasm32"))]
fn instance() -> (wgpu::Instance, wgpu::Backends) {
    static SHARED: std::sync::OnceLock<(wgpu::Instance, wgpu::Backends)> = std::sync::OnceLock::new();
    SHARED.get_or_init(new_instance).clone()
}

/// As above. In browsers there is nothing to open, and an instance does not leave its thread.
#[cfg(target_arch = "wasm32")]
fn instance() -> (wgpu::Instance, wgpu::Backends) {
    new_instance()
}

fn new_instance() -> (wgpu::Instance, wgpu::Backends) {
    let description = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    let backends = description.backends;
    (wgpu::Instance::new(description), backends)
}

/// Lists the adapters whose names contain `wanted`, the best first.
async fn adapters(instance: &wgpu::Instance, backends: wgpu::Backends, wanted: Option<&str>) -> Vec<wgpu::Adapter> {
    #[cfg(not(target_arch = "wasm32"))]
    let mut found = enumerated(instance, backends);
    #[cfg(target_arch = "wasm32")]
    let mut found = instance.enumerate_adapters(backends).await;
    if found.is_empty() {
        // browsers do not list their adapters
        let best = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        found.extend(instance.request_adapter(&best).await.ok());
    }
    if let Some(wanted) = wanted {
        let wanted = wanted.to_lowercase();
        found.retain(|a| a.get_info().name.to_lowercase().contains(&wanted));
    }
    found.sort_by_key(|a| {
        let info = a.get_info();
        rank(info.device_type, info.backend)
    });
    found
}

/// Lists the adapters of this process, those of OpenGL only if no other backend has a GPU.
///
/// They are searched once. Each search by wgpu wraps the same OpenGL context in a new lock, and it panics if the driver, like
/// NVIDIA's, refuses a context that is in use in another thread.
#[cfg(not(target_arch = "wasm32"))]
fn enumerated(instance: &wgpu::Instance, backends: wgpu::Backends) -> Vec<wgpu::Adapter> {
    static FOUND: Mutex<Vec<wgpu::Adapter>> = Mutex::new(Vec::new());
    let mut found = lock(&FOUND);
    if found.is_empty() {
        let look = |backends| pollster::block_on(instance.enumerate_adapters(backends));
        found.extend(look(backends - wgpu::Backends::GL));
        if found.iter().all(|a| a.get_info().device_type == wgpu::DeviceType::Cpu) {
            found.extend(look(backends & wgpu::Backends::GL));
        }
    }
    found.clone()
}

/// Describes the adapters of this machine, the best first.
#[cfg(not(target_arch = "wasm32"))]
pub fn descriptions() -> Vec<String> {
    let (instance, backends) = instance();
    let found = pollster::block_on(adapters(&instance, backends, None));
    found.iter().map(|adapter| describe(&adapter.get_info())).collect()
}

/// Ranks an adapter: the lower the better.
fn rank(kind: wgpu::DeviceType, backend: wgpu::Backend) -> (u8, u8) {
    use wgpu::{Backend, DeviceType};
    let kind = match kind {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    };
    // OpenGL does not blend over the edges of cube maps as wgpu sets it up
    (kind, u8::from(backend == Backend::Gl))
}

fn describe(info: &wgpu::AdapterInfo) -> String {
    let driver = if info.driver_info.is_empty() {
        String::new()
    } else {
        format!(", {}", info.driver_info)
    };
    format!("{} ({:?}, {:?}{driver})", info.name, info.backend, info.device_type)
}

fn names(backends: wgpu::Backends) -> String {
    let names: Vec<_> = backends.iter_names().map(|(name, _)| name.to_lowercase()).collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::rank;
    use wgpu::{Backend, DeviceType};

    #[test]
    fn gpus_come_before_software_and_opengl_last() {
        let order = [
            (DeviceType::DiscreteGpu, Backend::Vulkan),
            (DeviceType::DiscreteGpu, Backend::Gl),
            (DeviceType::IntegratedGpu, Backend::Metal),
            (DeviceType::VirtualGpu, Backend::Vulkan),
            (DeviceType::Other, Backend::Gl),
            (DeviceType::Cpu, Backend::Vulkan),
            (DeviceType::Cpu, Backend::Gl),
        ];
        let ranks = order.map(|(kind, backend)| rank(kind, backend));
        assert!(
            ranks.is_sorted() && ranks[0] < ranks[1] && ranks[5] < ranks[6],
            "{ranks:?}"
        );
    }
}
