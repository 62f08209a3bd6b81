// The real acceleration structures behind the program's: bottom-level ones of clusters by the address that the program has for them, and the
// instances of top-level ones.
#pragma once
#include "layer/memory.h"

#include <map>
#include <mutex>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace tessera::layer
{

struct Device;

// A bottom-level structure of clusters. The program's memory has its record; the driver's structure lies in memory of the layer.
struct BottomLevel
{
	VkDeviceSize record_bytes = 0;
	uint64_t serial = 0;  // as in the record
	VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
	VkDeviceAddress real_address = 0;
	VkDeviceSize structure_bytes = 0;
	std::shared_ptr<OwnBuffer> storage;
	uint32_t first_row = 0, row_count = 0;
	uint32_t first_index = 0, index_count = 0;  // of the table of geometry indices
	bool culls_nothing = false;                 // every geometry has CULL_DISABLE
};

// What the layer keeps for a top-level structure.
struct TopLevel
{
	uint32_t first_slot = 0, slot_count = 0;
	bool has_clusters = false;
	std::shared_ptr<OwnBuffer> instances;
};

class Structures
{
public:
	// A bottom-level structure now lies at `address`; what lay in its way is gone.
	void put(Device& device, VkDeviceAddress address, BottomLevel structure);
	// A copy of another; it shares that one's rows, which then stay for good.
	void putCopy(Device& device, VkDeviceAddress address, BottomLevel structure);
	// Null when there is none at this address. Valid until the next call that changes structures.
	const BottomLevel* find(VkDeviceAddress address) const;
	// The structure at `from` has moved to `to`.
	void moved(Device& device, VkDeviceAddress from, VkDeviceAddress to);
	// Something else was written to [first, end), or its buffer was destroyed.
	void memoryEnded(Device& device, VkDeviceAddress first, VkDeviceAddress end);

	void put(Device& device, VkAccelerationStructureKHR handle, TopLevel structure);
	void copied(Device& device, VkAccelerationStructureKHR source, VkAccelerationStructureKHR destination);
	void destroyed(Device& device, VkAccelerationStructureKHR handle);

	// There are top-level structures, and clusters in each.
	bool onlyClusters() const;

	// Structures of the driver, by whose addresses instances may refer to them.
	void driverAddress(VkAccelerationStructureKHR handle, VkDeviceAddress address);
	bool isDriverAddress(VkDeviceAddress address) const;

	// Ends one that was never put, or is put no more.
	void discard(Device& device, const BottomLevel& structure);
	void clear(Device& device);

private:
	void drop(Device& device, const TopLevel& structure);

	mutable std::mutex lock_;
	std::map<VkDeviceAddress, BottomLevel> bottom_;
	std::unordered_map<VkAccelerationStructureKHR, TopLevel> top_;
	std::unordered_map<VkAccelerationStructureKHR, VkDeviceAddress> driver_addresses_;
};

VKAPI_ATTR void VKAPI_CALL destroyAccelerationStructure(VkDevice device, VkAccelerationStructureKHR structure,
														const VkAllocationCallbacks* allocator);
VKAPI_ATTR VkDeviceAddress VKAPI_CALL getAccelerationStructureDeviceAddress(VkDevice device, const VkAccelerationStructureDeviceAddressInfoKHR* info);

}  // namespace tessera::layer
