// SPDX-License-Identifier: Apache-2.0
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "mesh_spirv.h"
#include "peer.h"
#include "uploads.h"
#include "zoneplate/base/error.h"

namespace zoneplate::peers {
namespace {

[[noreturn]] void fail(const std::string& what) { throw Error(ErrorKind::Failed, "Vulkan: " + what); }

constexpr vk::Format color_format = vk::Format::eR8G8B8A8Unorm, depth_format = vk::Format::eD32Sfloat;
constexpr auto color_aspect = vk::ImageAspectFlagBits::eColor;

struct Buffer {
  vk::raii::DeviceMemory memory;
  vk::raii::Buffer buffer;
  std::uint8_t* data;  ///< mapped
};

struct Image {
  vk::raii::DeviceMemory memory;
  vk::raii::Image image;
  vk::raii::ImageView view;
};

vk::raii::PhysicalDevice find_processor(const vk::raii::Instance& instance) {
  for (vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(instance))
    if (device.getProperties().deviceType == vk::PhysicalDeviceType::eCpu) return std::move(device);
  fail("no driver draws on the processor; apt-get install mesa-vulkan-drivers");
}

vk::raii::Instance make_instance(const vk::raii::Context& context) {
  const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_2};
  return {context, vk::InstanceCreateInfo{.pApplicationInfo = &application}};
}

vk::raii::Device make_device(const vk::raii::PhysicalDevice& processor) {
  constexpr float priority = 1;
  const vk::DeviceQueueCreateInfo queue{.queueCount = 1, .pQueuePriorities = &priority};
  const vk::PhysicalDeviceFeatures features{.samplerAnisotropy = true};
  return {processor,
          vk::DeviceCreateInfo{.queueCreateInfoCount = 1, .pQueueCreateInfos = &queue, .pEnabledFeatures = &features}};
}

class Lavapipe : public Peer {
 public:
  Lavapipe(const Scene& scene, const Work& work) : work_(work) {
    const auto properties =
        processor_.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
    const auto& driver = properties.get<vk::PhysicalDeviceDriverProperties>();
    const vk::PhysicalDeviceLimits& limits = properties.get<vk::PhysicalDeviceProperties2>().properties.limits;
    version_ = std::string("Vulkan ") + driver.driverName.data() + " " + driver.driverInfo.data();
    if (!(limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts & samples()))
      fail(version_ + " does not support " + std::to_string(work.samples) + " samples");
    make_targets();
    if (is_textured(scene)) upload(scene.images.at(0).pixels.as<Rgba8>());
    make_pipeline(scene);
    record(scene);
  }

  void frame() override { submit(frame_commands_); }

  Rgba8Image picture() const override {
    Rgba8Image out(work_.width, work_.height);
    std::memcpy(out.values().data(), pixels_->data, out.values().size_bytes());
    return out;
  }
  const std::string& version() const override { return version_; }

 private:
  Work work_;
  std::string version_;
  vk::raii::Context context_;
  vk::raii::Instance instance_ = make_instance(context_);
  vk::raii::PhysicalDevice processor_ = find_processor(instance_);
  vk::raii::Device device_ = make_device(processor_);
  vk::raii::Queue queue_{device_, 0, 0};
  vk::raii::Fence fence_{device_, vk::FenceCreateInfo{}};
  vk::raii::CommandPool pool_{device_, vk::CommandPoolCreateInfo{}};
  vk::raii::CommandBuffer frame_commands_ = make_commands();
  std::optional<Buffer> vertices_, indices_, pixels_;
  std::optional<Image> color_, depth_, resolved_, texture_;
  vk::raii::RenderPass pass_{nullptr};
  vk::raii::Framebuffer framebuffer_{nullptr};
  vk::raii::Sampler sampler_{nullptr};
  vk::raii::DescriptorSetLayout set_layout_{nullptr};
  vk::raii::DescriptorPool set_pool_{nullptr};
  vk::DescriptorSet set_;  // owned by set_pool_
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline pipeline_{nullptr};

  vk::SampleCountFlagBits samples() const { return static_cast<vk::SampleCountFlagBits>(work_.samples); }
  bool is_multisampled() const { return work_.samples > 1; }
  vk::Extent3D extent() const {
    return {static_cast<std::uint32_t>(work_.width), static_cast<std::uint32_t>(work_.height), 1};
  }

  vk::raii::CommandBuffer make_commands() {
    vk::raii::CommandBuffers buffers(device_, {.commandPool = *pool_, .commandBufferCount = 1});
    return std::move(buffers.front());
  }
  void submit(const vk::raii::CommandBuffer& commands) {
    const vk::CommandBuffer buffer = *commands;
    queue_.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &buffer}, *fence_);
    if (device_.waitForFences(*fence_, true, ~std::uint64_t{0}) != vk::Result::eSuccess) fail("a frame is not drawn");
    device_.resetFences(*fence_);
  }

  vk::raii::DeviceMemory allocate(vk::MemoryRequirements needs, vk::MemoryPropertyFlags flags) {
    const vk::PhysicalDeviceMemoryProperties types = processor_.getMemoryProperties();
    for (std::uint32_t i = 0; i < types.memoryTypeCount; ++i)
      if ((needs.memoryTypeBits >> i & 1) && (types.memoryTypes[i].propertyFlags & flags) == flags)
        return {device_, vk::MemoryAllocateInfo{.allocationSize = needs.size, .memoryTypeIndex = i}};
    fail("no memory of the needed type");
  }
  Buffer make_buffer(vk::DeviceSize size, vk::BufferUsageFlags usage) {
    vk::raii::Buffer buffer(device_, vk::BufferCreateInfo{.size = size, .usage = usage});
    vk::raii::DeviceMemory memory =
        allocate(buffer.getMemoryRequirements(),
                 vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
    buffer.bindMemory(*memory, 0);
    auto* data = static_cast<std::uint8_t*>(memory.mapMemory(0, VK_WHOLE_SIZE));
    return {std::move(memory), std::move(buffer), data};
  }
  template <class T>
  Buffer make_buffer(std::span<const T> values, vk::BufferUsageFlags usage) {
    Buffer out = make_buffer(values.size_bytes(), usage);
    std::memcpy(out.data, values.data(), values.size_bytes());
    return out;
  }
  Image make_image(vk::Format format, vk::Extent3D size, std::uint32_t levels, vk::SampleCountFlagBits count,
                   vk::ImageUsageFlags usage, vk::ImageAspectFlags aspect) {
    vk::raii::Image image(device_, vk::ImageCreateInfo{.imageType = vk::ImageType::e2D,
                                                       .format = format,
                                                       .extent = size,
                                                       .mipLevels = levels,
                                                       .arrayLayers = 1,
                                                       .samples = count,
                                                       .usage = usage});
    vk::raii::DeviceMemory memory = allocate(image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
    image.bindMemory(*memory, 0);
    vk::raii::ImageView view(device_, vk::ImageViewCreateInfo{.image = *image,
                                                              .viewType = vk::ImageViewType::e2D,
                                                              .format = format,
                                                              .subresourceRange = {aspect, 0, levels, 0, 1}});
    return {std::move(memory), std::move(image), std::move(view)};
  }

  void make_targets() {
    using Usage = vk::ImageUsageFlagBits;
    constexpr vk::ImageUsageFlags read_back = Usage::eColorAttachment | Usage::eTransferSrc;
    color_ = make_image(color_format, extent(), 1, samples(), read_back, color_aspect);
    depth_ = make_image(depth_format, extent(), 1, samples(), Usage::eDepthStencilAttachment,
                        vk::ImageAspectFlagBits::eDepth);
    std::vector<vk::ImageView> views{*color_->view, *depth_->view};
    if (is_multisampled()) {
      resolved_ = make_image(color_format, extent(), 1, vk::SampleCountFlagBits::e1, read_back, color_aspect);
      views.push_back(*resolved_->view);
    }
    pixels_ = make_buffer(vk::DeviceSize{extent().width} * extent().height * 4, vk::BufferUsageFlagBits::eTransferDst);

    using Load = vk::AttachmentLoadOp;
    using Store = vk::AttachmentStoreOp;
    using Layout = vk::ImageLayout;
    std::array<vk::AttachmentDescription, 3> attachments{
        {{.format = color_format,
          .samples = samples(),
          .loadOp = Load::eClear,
          .storeOp = is_multisampled() ? Store::eDontCare : Store::eStore,
          .finalLayout = is_multisampled() ? Layout::eColorAttachmentOptimal : Layout::eTransferSrcOptimal},
         {.format = depth_format,
          .samples = samples(),
          .loadOp = Load::eClear,
          .storeOp = Store::eDontCare,
          .finalLayout = Layout::eDepthStencilAttachmentOptimal},
         {.format = color_format,
          .samples = vk::SampleCountFlagBits::e1,
          .loadOp = Load::eDontCare,
          .storeOp = Store::eStore,
          .finalLayout = Layout::eTransferSrcOptimal}}};
    const vk::AttachmentReference color{0, Layout::eColorAttachmentOptimal},
        depth{1, Layout::eDepthStencilAttachmentOptimal}, resolved{2, Layout::eColorAttachmentOptimal};
    const vk::SubpassDescription subpass{.colorAttachmentCount = 1,
                                         .pColorAttachments = &color,
                                         .pResolveAttachments = is_multisampled() ? &resolved : nullptr,
                                         .pDepthStencilAttachment = &depth};
    const vk::SubpassDependency copy{.srcSubpass = 0,
                                     .dstSubpass = VK_SUBPASS_EXTERNAL,
                                     .srcStageMask = vk::PipelineStageFlagBits::eColorAttachmentOutput,
                                     .dstStageMask = vk::PipelineStageFlagBits::eTransfer,
                                     .srcAccessMask = vk::AccessFlagBits::eColorAttachmentWrite,
                                     .dstAccessMask = vk::AccessFlagBits::eTransferRead};
    const auto count = static_cast<std::uint32_t>(views.size());
    pass_ = {device_, vk::RenderPassCreateInfo{.attachmentCount = count,
                                               .pAttachments = attachments.data(),
                                               .subpassCount = 1,
                                               .pSubpasses = &subpass,
                                               .dependencyCount = 1,
                                               .pDependencies = &copy}};
    framebuffer_ = {device_, vk::FramebufferCreateInfo{.renderPass = *pass_,
                                                       .attachmentCount = count,
                                                       .pAttachments = views.data(),
                                                       .width = extent().width,
                                                       .height = extent().height,
                                                       .layers = 1}};
  }

  void upload(const Rgba8Image& image) {
    const std::vector<Rgba8Image> levels = mip_levels(image);
    const auto count = static_cast<std::uint32_t>(levels.size());
    const auto size_of = [](const Rgba8Image& level) {
      return vk::Extent3D{static_cast<std::uint32_t>(level.width()), static_cast<std::uint32_t>(level.height()), 1};
    };
    texture_ = make_image(color_format, size_of(image), count, vk::SampleCountFlagBits::e1,
                          vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst, color_aspect);
    std::vector<Rgba8> texels;
    std::vector<vk::BufferImageCopy> copies;
    for (std::uint32_t i = 0; i < count; ++i) {
      copies.push_back({.bufferOffset = texels.size() * sizeof(Rgba8),
                        .imageSubresource = {color_aspect, i, 0, 1},
                        .imageExtent = size_of(levels[i])});
      texels.insert(texels.end(), levels[i].values().begin(), levels[i].values().end());
    }
    const Buffer staging = make_buffer(std::span<const Rgba8>(texels), vk::BufferUsageFlagBits::eTransferSrc);
    const vk::raii::CommandBuffer commands = make_commands();
    commands.begin({});
    const auto change = [&](vk::ImageLayout from, vk::ImageLayout to) {
      constexpr auto all = vk::PipelineStageFlagBits::eAllCommands;
      constexpr auto access = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite;
      const vk::ImageMemoryBarrier barrier{.srcAccessMask = access,
                                           .dstAccessMask = access,
                                           .oldLayout = from,
                                           .newLayout = to,
                                           .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .image = *texture_->image,
                                           .subresourceRange = {color_aspect, 0, count, 0, 1}};
      commands.pipelineBarrier(all, all, {}, {}, {}, barrier);
    };
    change(vk::ImageLayout::eUndefined, vk::ImageLayout::eTransferDstOptimal);
    commands.copyBufferToImage(*staging.buffer, *texture_->image, vk::ImageLayout::eTransferDstOptimal, copies);
    change(vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::eShaderReadOnlyOptimal);
    commands.end();
    submit(commands);

    sampler_ = {device_, vk::SamplerCreateInfo{.magFilter = vk::Filter::eLinear,
                                               .minFilter = vk::Filter::eLinear,
                                               .mipmapMode = vk::SamplerMipmapMode::eLinear,
                                               .anisotropyEnable = work_.anisotropy > 1,
                                               .maxAnisotropy = static_cast<float>(work_.anisotropy),
                                               .maxLod = VK_LOD_CLAMP_NONE}};
  }

  vk::raii::ShaderModule make_shader(std::span<const std::uint32_t> code) {
    return {device_, vk::ShaderModuleCreateInfo{.codeSize = code.size_bytes(), .pCode = code.data()}};
  }

  void bind_texture() {
    constexpr auto type = vk::DescriptorType::eCombinedImageSampler;
    const vk::DescriptorSetLayoutBinding binding{
        .descriptorType = type, .descriptorCount = 1, .stageFlags = vk::ShaderStageFlagBits::eFragment};
    set_layout_ = {device_,
                   vk::DescriptorSetLayoutCreateInfo{.bindingCount = texture_ ? 1u : 0u, .pBindings = &binding}};
    if (!texture_) return;
    const vk::DescriptorPoolSize size{.type = type, .descriptorCount = 1};
    set_pool_ = {device_, vk::DescriptorPoolCreateInfo{.maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size}};
    const vk::DescriptorSetLayout layout = *set_layout_;
    set_ = (*device_)
               .allocateDescriptorSets({.descriptorPool = *set_pool_, .descriptorSetCount = 1, .pSetLayouts = &layout},
                                       *device_.getDispatcher())
               .front();
    const vk::DescriptorImageInfo image{
        .sampler = *sampler_, .imageView = *texture_->view, .imageLayout = vk::ImageLayout::eShaderReadOnlyOptimal};
    device_.updateDescriptorSets(
        vk::WriteDescriptorSet{.dstSet = set_, .descriptorCount = 1, .descriptorType = type, .pImageInfo = &image}, {});
  }

  void make_pipeline(const Scene& scene) {
    bind_texture();
    const vk::PushConstantRange uniforms{
        .stageFlags = vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment, .size = sizeof(Uniforms)};
    const vk::DescriptorSetLayout set_layout = *set_layout_;
    layout_ = {device_, vk::PipelineLayoutCreateInfo{.setLayoutCount = 1,
                                                     .pSetLayouts = &set_layout,
                                                     .pushConstantRangeCount = 1,
                                                     .pPushConstantRanges = &uniforms}};

    const std::size_t variant = (is_lit(scene) ? 1u : 0u) + (is_textured(scene) ? 2u : 0u);
    const std::array<std::span<const std::uint32_t>, 4> vertex_code{vert_plain, vert_lit, vert_textured,
                                                                    vert_lit_textured};
    const std::array<std::span<const std::uint32_t>, 4> fragment_code{frag_plain, frag_lit, frag_textured,
                                                                      frag_lit_textured};
    const vk::raii::ShaderModule vertex = make_shader(vertex_code[variant]),
                                 fragment = make_shader(fragment_code[variant]);
    const std::array<vk::PipelineShaderStageCreateInfo, 2> stages{
        {{.stage = vk::ShaderStageFlagBits::eVertex, .module = *vertex, .pName = "main"},
         {.stage = vk::ShaderStageFlagBits::eFragment, .module = *fragment, .pName = "main"}}};

    const vk::VertexInputBindingDescription record{0, 32, vk::VertexInputRate::eVertex};
    const std::array<vk::VertexInputAttributeDescription, 3> attributes{{{0, 0, vk::Format::eR32G32B32Sfloat, 0},
                                                                         {1, 0, vk::Format::eR32G32B32Sfloat, 12},
                                                                         {2, 0, vk::Format::eR32G32Sfloat, 24}}};
    const vk::PipelineVertexInputStateCreateInfo input{.vertexBindingDescriptionCount = 1,
                                                       .pVertexBindingDescriptions = &record,
                                                       .vertexAttributeDescriptionCount = 3,
                                                       .pVertexAttributeDescriptions = attributes.data()};
    const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
    const auto width = static_cast<float>(work_.width), height = static_cast<float>(work_.height);
    const vk::Viewport viewport{0, height, width, -height, 0, 1};  // y up, as in OpenGL
    const vk::Rect2D scissor{{0, 0}, {extent().width, extent().height}};
    const vk::PipelineViewportStateCreateInfo view{
        .viewportCount = 1, .pViewports = &viewport, .scissorCount = 1, .pScissors = &scissor};
    const Material& material = scene.materials.at(0);
    const vk::PipelineRasterizationStateCreateInfo raster{
        .cullMode = material.double_sided ? vk::CullModeFlagBits::eNone : vk::CullModeFlagBits::eBack,
        .frontFace = vk::FrontFace::eCounterClockwise,
        .lineWidth = 1};
    const vk::PipelineMultisampleStateCreateInfo multisample{.rasterizationSamples = samples()};
    const vk::PipelineDepthStencilStateCreateInfo depth{
        .depthTestEnable = true, .depthWriteEnable = true, .depthCompareOp = vk::CompareOp::eLess};
    using Factor = vk::BlendFactor;
    using Component = vk::ColorComponentFlagBits;
    const vk::PipelineColorBlendAttachmentState blend{
        .blendEnable = material.alpha_mode == AlphaMode::Blend,
        .srcColorBlendFactor = Factor::eSrcAlpha,
        .dstColorBlendFactor = Factor::eOneMinusSrcAlpha,
        .srcAlphaBlendFactor = Factor::eSrcAlpha,
        .dstAlphaBlendFactor = Factor::eOneMinusSrcAlpha,
        .colorWriteMask = Component::eR | Component::eG | Component::eB | Component::eA};
    const vk::PipelineColorBlendStateCreateInfo blends{.attachmentCount = 1, .pAttachments = &blend};
    pipeline_ = {device_, nullptr,
                 vk::GraphicsPipelineCreateInfo{.stageCount = 2,
                                                .pStages = stages.data(),
                                                .pVertexInputState = &input,
                                                .pInputAssemblyState = &assembly,
                                                .pViewportState = &view,
                                                .pRasterizationState = &raster,
                                                .pMultisampleState = &multisample,
                                                .pDepthStencilState = &depth,
                                                .pColorBlendState = &blends,
                                                .layout = *layout_,
                                                .renderPass = *pass_}};
  }

  /// Records what each frame submits: clear, draw, resolve and copy into mapped memory.
  void record(const Scene& scene) {
    const Mesh& mesh = scene.meshes.at(0);
    const std::vector<float> vertices = interleaved_vertices(mesh);
    vertices_ = make_buffer(std::span<const float>(vertices), vk::BufferUsageFlagBits::eVertexBuffer);
    indices_ = make_buffer(std::span<const std::uint32_t>(mesh.index), vk::BufferUsageFlagBits::eIndexBuffer);
    std::array<vk::ClearValue, 2> clear{};
    clear[0].color.setFloat32({work_.background.x, work_.background.y, work_.background.z, 1});
    clear[1].depthStencil.setDepth(1);

    const vk::raii::CommandBuffer& commands = frame_commands_;
    commands.begin({});
    commands.beginRenderPass({.renderPass = *pass_,
                              .framebuffer = *framebuffer_,
                              .renderArea = {{0, 0}, {extent().width, extent().height}},
                              .clearValueCount = 2,
                              .pClearValues = clear.data()},
                             vk::SubpassContents::eInline);
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline_);
    commands.bindVertexBuffers(0, *vertices_->buffer, vk::DeviceSize{0});
    commands.bindIndexBuffer(*indices_->buffer, 0, vk::IndexType::eUint32);
    if (set_) commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0, set_, {});
    const Uniforms uniforms = uniforms_of(scene, work_);
    commands.pushConstants<Uniforms>(*layout_, vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment, 0,
                                     uniforms);
    commands.drawIndexed(static_cast<std::uint32_t>(mesh.index.size()), 1, 0, 0, 0);
    commands.endRenderPass();
    commands.copyImageToBuffer(
        *(resolved_ ? resolved_ : color_)->image, vk::ImageLayout::eTransferSrcOptimal, *pixels_->buffer,
        vk::BufferImageCopy{.imageSubresource = {color_aspect, 0, 0, 1}, .imageExtent = extent()});
    commands.end();
  }
};

}  // namespace

std::unique_ptr<Peer> make_lavapipe(const Scene& scene, const Work& work) {
  try {
    return std::make_unique<Lavapipe>(scene, work);
  } catch (const vk::Error& error) {
    fail(error.what());
  } catch (const std::runtime_error& error) {  // from vk::raii::Context: there is no libvulkan.so.1
    if (dynamic_cast<const Error*>(&error)) throw;
    fail(error.what());
  }
}

}  // namespace zoneplate::peers
