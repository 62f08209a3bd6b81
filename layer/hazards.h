// Barriers between the commands that the host executes. It executes them one after the other, so a missing barrier would show on a device only: what
// each of them reads and writes is compared with what earlier ones of the same command buffer did since the last sufficient barrier.
#pragma once
#include <vulkan/vulkan.h>

#include <map>
#include <string>
#include <vector>

namespace tessera::layer
{

class Report;

// Does a barrier order builds of acceleration structures after earlier ones and show them what those wrote?
bool ordersBuilds(VkPipelineStageFlags from, VkPipelineStageFlags to, uint32_t count, const VkMemoryBarrier* barriers, uint32_t buffer_count,
				  const VkBufferMemoryBarrier* buffers);
bool ordersBuilds(const VkDependencyInfo& dependency);

class Hazards
{
public:
	// A command begins; `epoch` counts the sufficient barriers before it.
	void begin(uint32_t epoch, const char* command);
	void read(VkDeviceAddress address, VkDeviceSize size, const char* what) { add(address, size, what, false); }
	void write(VkDeviceAddress address, VkDeviceSize size, const char* what) { add(address, size, what, true); }
	// It has ended: names what it did without a barrier, one violation per kind of access.
	void end(Report& report);

private:
	struct Access
	{
		VkDeviceAddress first, end;
		const char* what;
		const char* command;
		bool writes;
	};
	// Of the epoch, by first address; accesses that touch and are alike are one.
	using Accesses = std::map<VkDeviceAddress, Access>;

	void add(VkDeviceAddress address, VkDeviceSize size, const char* what, bool writes);
	static const Access* overlapping(const Accesses& earlier, const Access& access);
	static void merge(Accesses& into, Access access);

	uint32_t epoch_ = 0;
	const char* command_ = "";
	std::vector<Access> current_;
	Accesses reads_, writes_;
};

}  // namespace tessera::layer
