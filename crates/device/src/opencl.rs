//! The kernels on a device of OpenCL.

use crate::program;
use mesh::Padded;
use opencl3::command_queue::CommandQueue;
use opencl3::context::Context;
use opencl3::device::{CL_DEVICE_TYPE_ALL, CL_DEVICE_TYPE_GPU, Device, get_all_devices};
use opencl3::error_codes::ClError;
use opencl3::kernel::{ExecuteKernel, Kernel};
use opencl3::memory::{Buffer, CL_MEM_READ_WRITE};
use opencl3::program::Program;
use opencl3::types::CL_BLOCKING;
use solid::{DeviceElements, Solid};
use std::ptr::null_mut;
use thiserror::Error;

/// Elements or nodes that a device takes together; with 255 registers each they fill what a multiprocessor of NVIDIA has.
const GROUP: usize = 256;

/// Why a device cannot be used.
#[derive(Debug, Error)]
pub enum DeviceError {
    /// There is no driver.
    #[error("there is no driver of OpenCL here: {0}")]
    Driver(ClError),
    /// No device computes in double precision.
    #[error("no device of OpenCL here computes in double precision")]
    None,
    /// A call that failed.
    #[error("the device failed: {0}")]
    Call(#[from] ClError),
    /// Kernels that its compiler refuses.
    #[error("the kernels do not compile: {0}")]
    Program(String),
}

/// The bodies on a device.
pub struct Bodies {
    queue: CommandQueue,
    elements: DeviceElements,
    element_kernels: Vec<Kernel>,
    subtract_forces: Kernel,
    advance: Kernel,
    corner_nodes: Buffer<u32>,
    begin: Buffer<u32>,
    places: Buffer<u32>,
    reference: Buffer<Padded>,
    displacement: Buffer<Padded>,
    velocity: Buffer<Padded>,
    force: Buffer<Padded>,
    inverse_mass: Buffer<f64>,
    corners: Buffer<f64>,
    nodes: usize,
    _program: Program,
    context: Context,
}

impl Bodies {
    /// The bodies of `solid` on a device, a graphics processor if there is one, at rest, with these inverse masses (1/kg).
    ///
    /// # Errors
    /// No device, or one that fails.
    ///
    /// # Panics
    /// If there are not as many inverse masses as nodes.
    pub fn new(solid: &Solid, inverse_mass: &[f64]) -> Result<Self, DeviceError> {
        assert_eq!(inverse_mass.len(), solid.reference().len());
        let device = first()?;
        let context = Context::from_device(&device)?;
        let queue = CommandQueue::create_default_with_properties(&context, 0, 0)?;
        let elements = solid.on_device();
        let text = program::text(program::OPENCL, &elements);
        let program = Program::create_and_build_from_source(&context, &text, "-cl-std=CL1.2")
            .map_err(DeviceError::Program)?;
        let kernel = |name: &str| Kernel::create(&program, name);
        let nodes = solid.reference().len();
        let rest = vec![Padded::ZERO; nodes];
        let element_kernels =
            (0..elements.kinds.len()).map(|kind| kernel(&format!("elements_{kind}")));
        Ok(Self {
            element_kernels: element_kernels.collect::<Result<_, _>>()?,
            subtract_forces: kernel("subtract_forces")?,
            advance: kernel("advance")?,
            corner_nodes: filled(&context, &queue, &elements.nodes)?,
            begin: filled(&context, &queue, &elements.begin)?,
            places: filled(&context, &queue, &elements.places)?,
            reference: filled(&context, &queue, solid.reference())?,
            displacement: filled(&context, &queue, &rest)?,
            velocity: filled(&context, &queue, &rest)?,
            force: filled(&context, &queue, &rest)?,
            inverse_mass: filled(&context, &queue, inverse_mass)?,
            corners: filled(&context, &queue, &vec![0.0; 3 * elements.nodes.len()])?,
            nodes,
            elements,
            queue,
            _program: program,
            context,
        })
    }

    /// Sets displacements (m) and velocities (m/s).
    ///
    /// # Errors
    /// A device that fails.
    ///
    /// # Panics
    /// If there are not as many as nodes.
    pub fn set(&mut self, displacement: &[Padded], velocity: &[Padded]) -> Result<(), DeviceError> {
        assert_eq!([displacement.len(), velocity.len()], [self.nodes; 2]);
        write(&self.queue, &mut self.displacement, displacement)?;
        write(&self.queue, &mut self.velocity, velocity)
    }

    /// Displacements, velocities and forces (N).
    ///
    /// # Errors
    /// A device that fails.
    pub fn get(&self) -> Result<[Vec<Padded>; 3], DeviceError> {
        let mut fields = [(); 3].map(|()| vec![Padded::ZERO; self.nodes]);
        for (buffer, field) in
            [&self.displacement, &self.velocity, &self.force].into_iter().zip(&mut fields)
        {
            // SAFETY: the buffer has as many vectors, and the call blocks until they are here.
            unsafe { self.queue.enqueue_read_buffer(buffer, CL_BLOCKING, 0, field, &[])? };
        }
        Ok(fields)
    }

    /// The name of the device, and whether it is a graphics processor.
    ///
    /// # Errors
    /// A device that fails.
    pub fn device(&self) -> Result<(String, bool), DeviceError> {
        let device = Device::new(self.context.default_device());
        Ok((device.name()?, is_graphics_processor(&device)))
    }

    /// Waits until the device has done all that it was given.
    ///
    /// # Errors
    /// A device that fails.
    pub fn finish(&self) -> Result<(), DeviceError> {
        Ok(self.queue.finish()?)
    }

    /// Subtracts the internal force.
    ///
    /// # Errors
    /// A device that fails.
    pub fn subtract_internal_force(&mut self) -> Result<(), DeviceError> {
        let count = (self.elements.nodes.len() / 8) as u32;
        for (kernel, kind) in self.element_kernels.iter().zip(&self.elements.kinds) {
            // SAFETY: the arguments are those of the text, and no kernel reads or writes beyond its buffers: node numbers are
            // of the mesh, and there are 24 numbers for each element.
            unsafe {
                ExecuteKernel::new(kernel)
                    .set_arg(&(kind.first as u32))
                    .set_arg(&(kind.count as u32))
                    .set_arg(&count)
                    .set_arg(&self.corner_nodes)
                    .set_arg(&self.reference)
                    .set_arg(&self.displacement)
                    .set_arg(&self.velocity)
                    .set_arg(&self.corners)
                    .set_local_work_size(GROUP)
                    .set_global_work_size(kind.count.next_multiple_of(GROUP))
                    .enqueue_nd_range(&self.queue)?;
            }
        }
        // SAFETY: as before; `places` are within the corners, `begin` within `places`.
        unsafe {
            ExecuteKernel::new(&self.subtract_forces)
                .set_arg(&(self.nodes as u32))
                .set_arg(&count)
                .set_arg(&self.begin)
                .set_arg(&self.places)
                .set_arg(&self.corners)
                .set_arg(&self.force)
                .set_local_work_size(GROUP)
                .set_global_work_size(self.nodes.next_multiple_of(GROUP))
                .enqueue_nd_range(&self.queue)?;
        }
        Ok(())
    }

    /// Central difference with a step `dt` (s); clears the forces.
    ///
    /// # Errors
    /// A device that fails.
    pub fn advance(&mut self, dt: f64) -> Result<(), DeviceError> {
        // SAFETY: as in `subtract_internal_force`; all nodal arrays have as many entries as there are nodes.
        unsafe {
            ExecuteKernel::new(&self.advance)
                .set_arg(&(self.nodes as u32))
                .set_arg(&dt)
                .set_arg(&self.inverse_mass)
                .set_arg(&self.force)
                .set_arg(&self.displacement)
                .set_arg(&self.velocity)
                .set_local_work_size(GROUP)
                .set_global_work_size(self.nodes.next_multiple_of(GROUP))
                .enqueue_nd_range(&self.queue)?;
        }
        Ok(())
    }
}

fn is_graphics_processor(device: &Device) -> bool {
    device.dev_type().is_ok_and(|kind| kind & CL_DEVICE_TYPE_GPU != 0)
}

/// The first graphics processor with double precision, or else the first device with it.
fn first() -> Result<Device, DeviceError> {
    let ids = get_all_devices(CL_DEVICE_TYPE_ALL).map_err(DeviceError::Driver)?;
    let devices: Vec<Device> = ids.into_iter().map(Device::new).collect();
    let usable = devices.iter().filter(|device| device.double_fp_config().is_ok_and(|d| d != 0));
    usable.max_by_key(|device| is_graphics_processor(device)).copied().ok_or(DeviceError::None)
}

/// A buffer that holds `values`.
fn filled<T>(
    context: &Context,
    queue: &CommandQueue,
    values: &[T],
) -> Result<Buffer<T>, DeviceError> {
    // SAFETY: no memory of the host is given.
    let mut buffer =
        unsafe { Buffer::create(context, CL_MEM_READ_WRITE, values.len(), null_mut())? };
    write(queue, &mut buffer, values)?;
    Ok(buffer)
}

fn write<T>(queue: &CommandQueue, buffer: &mut Buffer<T>, values: &[T]) -> Result<(), DeviceError> {
    // SAFETY: the buffer has room for as many values, and the call blocks until they are there.
    unsafe { queue.enqueue_write_buffer(buffer, CL_BLOCKING, 0, values, &[])? };
    Ok(())
}
