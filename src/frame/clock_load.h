// Keeps a GPU's clock up while frames are measured one at a time.
#pragma once
#include "gpu/commands.h"
#include "gpu/pipeline_store.h"

namespace tessera
{

// Work that fills the time between the end of one measured frame and the beginning of the next, while the host reads the one and records the other:
// a GPU that is idle half of the time lowers its clock by as much as a third, and small frames would be measured slower than large ones. Frames
// submitted later begin when it has ended, so their own times do not change. Nothing on a device that is a processor.
class ClockLoad
{
public:
	// About half a millisecond on a GPU of 2024.
	static constexpr uint32_t kTurns = 160'000;

	// Errors: DeviceCannot (the shader is missing), BadInput (out of memory).
	static Result<std::unique_ptr<ClockLoad>> create(Device& device, uint32_t turns = kTurns);

	// After a frame that has been waited for. Does not wait itself. Errors: DeviceLost.
	Status submit();

private:
	ClockLoad(Device& device, uint32_t turns) : device_(device), turns_(turns) {}

	Device& device_;
	uint32_t turns_;
	PipelineStore::Shared pipeline_;
	Buffer result_;
	std::unique_ptr<CommandRecorder> commands_;  // goes first: it waits for the device, which uses what stands above
};

}  // namespace tessera
