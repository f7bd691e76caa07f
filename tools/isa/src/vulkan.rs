//! The driver. The only file of the workspace with `unsafe`: Vulkan has no safe calls.
#![expect(unsafe_code, reason = "every call of Vulkan is unsafe")]
// Objects live until the process ends, as does the device: a caller compiles a few dozen shaders.

use std::ffi::{CStr, CString};
use std::time::{Duration, Instant};

use ash::khr::pipeline_executable_properties as properties;
use ash::vk;

use crate::shader::{Binding, Kind, Shader, Stages};
use crate::{Compiled, Error, Statistic};

/// Of the attachment that fragment stages write.
const COLOR_FORMAT: vk::Format = vk::Format::R8G8B8A8_SRGB;

/// A device that compiles.
pub struct Compiler {
    device: ash::Device,
    properties: properties::Device,
    name: String,
    // Keeps the driver loaded.
    _instance: ash::Instance,
    _entry: ash::Entry,
}

impl std::fmt::Debug for Compiler {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Compiler")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl Compiler {
    /// Opens the device that most resembles a graphics card.
    ///
    /// Vulkan's loader and drivers read the environment when this is called.
    ///
    /// # Errors
    /// [`Error::Loader`], [`Error::Device`] or [`Error::Statistics`] where something is missing.
    pub fn open() -> Result<Self, Error> {
        // SAFETY: Vulkan's loader may be loaded from any thread; it is trusted as the system's.
        let entry = unsafe { ash::Entry::load() }.map_err(|e| Error::Loader(e.to_string()))?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_1);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: `info` and what it points at live through the call.
        let instance = unsafe { entry.create_instance(&info, None) };
        let instance = match instance {
            Err(vk::Result::ERROR_INCOMPATIBLE_DRIVER) => return Err(Error::Device),
            other => checked("vkCreateInstance", other)?,
        };
        let (chip, name) = best_device(&instance)?;
        let device = open_device(&instance, chip, &name)?;
        Ok(Self {
            properties: properties::Device::new(&instance, &device),
            device,
            name,
            _instance: instance,
            _entry: entry,
        })
    }

    /// The device, as its driver calls it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Compiles a shader whose only bindings are buffers: a kernel, or a vertex and a fragment
    /// stage, of which the fragment stage is reported.
    ///
    /// # Errors
    /// [`Error::Shader`] where the text is not such a shader, [`Error::Vulkan`] where the driver
    /// does not compile it.
    pub fn compile(&self, wgsl: &str) -> Result<Compiled, Error> {
        let shader = Shader::new(wgsl)?;
        let info = vk::ShaderModuleCreateInfo::default().code(&shader.spirv);
        // SAFETY: the words are naga's own, written from a validated module.
        let module = unsafe { self.device.create_shader_module(&info, None) };
        let module = checked("vkCreateShaderModule", module)?;
        let layout = self.layout(&shader.groups)?;
        let (pipeline, time, stage) = match &shader.stages {
            Stages::Compute(entry_point) => self.compute(module, layout, entry_point)?,
            Stages::Graphics { vertex, fragment } => {
                self.graphics(module, layout, [vertex, fragment])?
            }
        };
        Ok(Compiled {
            time,
            statistics: self.statistics(pipeline, stage)?,
        })
    }

    fn layout(&self, groups: &[Vec<Binding>]) -> Result<vk::PipelineLayout, Error> {
        let mut layouts = Vec::new();
        for group in groups {
            let bindings: Vec<_> = group.iter().copied().map(layout_binding).collect();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: `info` and what it points at live through the call.
            let layout = unsafe { self.device.create_descriptor_set_layout(&info, None) };
            layouts.push(checked("vkCreateDescriptorSetLayout", layout)?);
        }
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts);
        // SAFETY: the layouts are of this device.
        let layout = unsafe { self.device.create_pipeline_layout(&info, None) };
        checked("vkCreatePipelineLayout", layout)
    }

    fn compute(
        &self,
        module: vk::ShaderModule,
        layout: vk::PipelineLayout,
        entry_point: &str,
    ) -> Result<(vk::Pipeline, Duration, vk::ShaderStageFlags), Error> {
        let name = entry_name(entry_point)?;
        let stage = vk::ShaderStageFlags::COMPUTE;
        let info = vk::ComputePipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
            .layout(layout)
            .stage(stage_info(module, stage, &name));
        let (pipeline, time) = timed("vkCreateComputePipelines", || {
            // SAFETY: module and layout are of this device, and the layout has the shader's bindings.
            unsafe {
                self.device
                    .create_compute_pipelines(vk::PipelineCache::null(), &[info], None)
            }
        })?;
        Ok((pipeline, time, stage))
    }

    /// A triangle list without vertex buffers onto one colour attachment.
    fn graphics(
        &self,
        module: vk::ShaderModule,
        layout: vk::PipelineLayout,
        [vertex, fragment]: [&str; 2],
    ) -> Result<(vk::Pipeline, Duration, vk::ShaderStageFlags), Error> {
        let names = [entry_name(vertex)?, entry_name(fragment)?];
        let stage = vk::ShaderStageFlags::FRAGMENT;
        let stages = [
            stage_info(module, vk::ShaderStageFlags::VERTEX, &names[0]),
            stage_info(module, stage, &names[1]),
        ];
        let vertices = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let written = [vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&written);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
            .stages(&stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .render_pass(self.render_pass()?);
        let (pipeline, time) = timed("vkCreateGraphicsPipelines", || {
            // SAFETY: all objects are of this device, and all structures live through the call.
            unsafe {
                self.device
                    .create_graphics_pipelines(vk::PipelineCache::null(), &[info], None)
            }
        })?;
        Ok((pipeline, time, stage))
    }

    fn render_pass(&self) -> Result<vk::RenderPass, Error> {
        let attachments = [vk::AttachmentDescription::default()
            .format(COLOR_FORMAT)
            .samples(vk::SampleCountFlags::TYPE_1)
            .final_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)];
        let colors = [
            vk::AttachmentReference::default().layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
        ];
        let subpasses = [vk::SubpassDescription::default().color_attachments(&colors)];
        let info = vk::RenderPassCreateInfo::default()
            .attachments(&attachments)
            .subpasses(&subpasses);
        // SAFETY: `info` and what it points at live through the call.
        let pass = unsafe { self.device.create_render_pass(&info, None) };
        checked("vkCreateRenderPass", pass)
    }

    /// Of the first executable that `stage` became.
    fn statistics(
        &self,
        pipeline: vk::Pipeline,
        stage: vk::ShaderStageFlags,
    ) -> Result<Vec<Statistic>, Error> {
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        // SAFETY: the pipeline is of this device, which has the extension.
        let executables = unsafe { self.properties.get_pipeline_executable_properties(&info) };
        let executables = checked("vkGetPipelineExecutablePropertiesKHR", executables)?;
        let index = (0..)
            .zip(&executables)
            .find(|(_, executable)| executable.stages.contains(stage))
            .map(|(index, _)| index)
            .ok_or_else(|| Error::Statistics(self.name.clone()))?;
        let info = vk::PipelineExecutableInfoKHR::default()
            .pipeline(pipeline)
            .executable_index(index);
        // SAFETY: as above; the pipeline was made with CAPTURE_STATISTICS, and has the executable.
        let found = unsafe { self.properties.get_pipeline_executable_statistics(&info) };
        let found = checked("vkGetPipelineExecutableStatisticsKHR", found)?;
        Ok(found.iter().map(statistic).collect())
    }
}

fn checked<T>(call: &'static str, result: ash::prelude::VkResult<T>) -> Result<T, Error> {
    result.map_err(|error| Error::Vulkan {
        call,
        result: format!("{error:?}"),
    })
}

/// A card before a chip on the board before anything else; the first of equals.
fn best_device(instance: &ash::Instance) -> Result<(vk::PhysicalDevice, String), Error> {
    // SAFETY: the instance is alive.
    let devices = unsafe { instance.enumerate_physical_devices() };
    let devices = checked("vkEnumeratePhysicalDevices", devices)?;
    let described = devices.into_iter().map(|device| {
        // SAFETY: the device is of this instance.
        (device, unsafe {
            instance.get_physical_device_properties(device)
        })
    });
    let rank = |kind| match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => 0,
        vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
        _ => 2,
    };
    let (device, properties) = described
        .min_by_key(|(_, properties)| rank(properties.device_type))
        .ok_or(Error::Device)?;
    Ok((device, text(properties.device_name_as_c_str())))
}

fn open_device(
    instance: &ash::Instance,
    chip: vk::PhysicalDevice,
    name: &str,
) -> Result<ash::Device, Error> {
    // SAFETY: the physical device is of this instance.
    let offered = unsafe { instance.enumerate_device_extension_properties(chip) };
    let offered = checked("vkEnumerateDeviceExtensionProperties", offered)?;
    let has_statistics = offered
        .iter()
        .any(|extension| extension.extension_name_as_c_str() == Ok(properties::NAME));
    if !has_statistics {
        return Err(Error::Statistics(name.to_owned()));
    }
    // Family 0: whatever it can do, nothing is submitted.
    let queues = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
    let extensions = [properties::NAME.as_ptr()];
    let mut statistics = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
        .pipeline_executable_info(true);
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .push_next(&mut statistics);
    // SAFETY: `info` and what it points at live through the call; the extension is offered.
    let device = unsafe { instance.create_device(chip, &info, None) };
    checked("vkCreateDevice", device)
}

fn layout_binding(binding: Binding) -> vk::DescriptorSetLayoutBinding<'static> {
    vk::DescriptorSetLayoutBinding::default()
        .binding(binding.binding)
        .descriptor_type(match binding.kind {
            Kind::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
            Kind::Storage => vk::DescriptorType::STORAGE_BUFFER,
            Kind::Texture => vk::DescriptorType::SAMPLED_IMAGE,
            Kind::Sampler => vk::DescriptorType::SAMPLER,
        })
        .descriptor_count(1)
        .stage_flags(vk::ShaderStageFlags::ALL)
}

fn stage_info(
    module: vk::ShaderModule,
    stage: vk::ShaderStageFlags,
    entry_point: &CStr,
) -> vk::PipelineShaderStageCreateInfo<'_> {
    vk::PipelineShaderStageCreateInfo::default()
        .module(module)
        .stage(stage)
        .name(entry_point)
}

fn entry_name(entry_point: &str) -> Result<CString, Error> {
    CString::new(entry_point).map_err(|error| Error::Shader(error.to_string()))
}

/// The pipeline that `make` makes, and how long that takes.
fn timed(
    call: &'static str,
    make: impl FnOnce() -> Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
) -> Result<(vk::Pipeline, Duration), Error> {
    let start = Instant::now();
    let made = make();
    let time = start.elapsed();
    let made = checked(call, made.map_err(|(_, error)| error))?;
    let pipeline = made.first().copied().ok_or(Error::Device)?;
    Ok((pipeline, time))
}

fn statistic(found: &vk::PipelineExecutableStatisticKHR<'_>) -> Statistic {
    let value = found.value;
    // SAFETY: the format says which field of the union the driver wrote.
    let value = unsafe {
        match found.format {
            vk::PipelineExecutableStatisticFormatKHR::BOOL32 => f64::from(value.b32),
            vk::PipelineExecutableStatisticFormatKHR::INT64 => value.i64 as f64,
            vk::PipelineExecutableStatisticFormatKHR::FLOAT64 => value.f64,
            _ => value.u64 as f64,
        }
    };
    Statistic {
        name: text(found.name_as_c_str()),
        value,
    }
}

fn text<E>(name: Result<&CStr, E>) -> String {
    name.map_or_else(
        |_| "?".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    )
}
