#include "frame/clock_load.h"

#include "measuring/keep_clock.h"

namespace tessera
{

constexpr uint32_t kWorkgroups = 1024;

Result<std::unique_ptr<ClockLoad>> ClockLoad::create(Device& device, uint32_t turns)
{
	std::unique_ptr<ClockLoad> load(new ClockLoad(device, turns));
	if (device.is_cpu)
		return load;
	TRY_ASSIGN(load->commands_, CommandRecorder::create(device));
	TRY_ASSIGN(const Shader shader, loadShader("measuring/keep_clock.comp"));
	TRY_ASSIGN(load->pipeline_, device.pipelines->get(shader, {}));
	TRY_ASSIGN(load->result_, Buffer::create(device, sizeof(uint32_t), MemoryKind::Device, "clock_load"));
	return load;
}

Status ClockLoad::submit()
{
	if (device_.is_cpu)
		return {};
	TRY(commands_->wait());
	TRY(commands_->begin());
	KeepClockArgs args = {};
	args.result = result_.address();
	args.turns = turns_;
	vkCmdBindPipeline(commands_->buffer(), VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_->handle());
	vkCmdPushConstants(commands_->buffer(), device_.pipelines->layout(), VK_SHADER_STAGE_ALL, 0, sizeof(args), &args);
	vkCmdDispatch(commands_->buffer(), kWorkgroups, 1, 1);
	// What comes later waits for it: the next frame's first timestamp, too.
	fullBarrier(commands_->buffer());
	return commands_->submit();
}

}  // namespace tessera
