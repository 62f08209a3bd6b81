#include "layer/operation.h"

#include <algorithm>

namespace tessera::layer
{

namespace
{

constexpr VkBufferUsageFlags kStorageUsage = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR;

struct Span
{
	VkDeviceAddress first = 0, end = 0;
	bool overlaps(const Span& other) const { return first < other.end && other.first < end; }
};

// The array's place for `count` entries, null without one (then a violation said why, or the array is not there).
std::optional<Place> arrayPlace(const Operation& operation, const char* what, const VkStridedDeviceAddressRegionKHR& array, VkDeviceSize entry_bytes,
								uint32_t count, VkBufferUsageFlags usage)
{
	if (array.stride < entry_bytes || array.stride % entry_bytes != 0)
		operation.report().violation(fmt::format("{}-stride", what), "{}: {} has stride {}, right is a multiple of {}, at least {}", operation.name(),
									 what, array.stride, entry_bytes, entry_bytes);
	if (count == 0)
		return std::nullopt;
	checkAlignment(operation, what, array.deviceAddress, entry_bytes, what);
	const VkDeviceSize needed = array.stride * (count - 1) + entry_bytes;
	if (array.size < needed)
		operation.report().violation(fmt::format("{}-size", what), "{}: {} has {} bytes, {} entries of stride {} need {}", operation.name(), what,
									 array.size, count, array.stride, needed);
	const bool read_only =
		std::string_view(what) == "dst-addresses" && operation.input.mode() == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_EXPLICIT_DESTINATIONS_NV;
	if (read_only)
		operation.context.hazards.read(array.deviceAddress, needed, what);
	else
		operation.context.hazards.write(array.deviceAddress, needed, what);
	return placeOf(operation, what, array.deviceAddress, needed, usage, what);
}

template <typename Value>
VkResult readArray(const Operation& operation, const Place& place, VkDeviceSize stride, std::vector<Value>& values)
{
	Reads reads;
	reads.add(place, stride * (values.size() - 1) + sizeof(Value));
	const VkResult result = operation.context.read(reads);
	if (result == VK_SUCCESS)
		for (size_t i = 0; i < values.size(); ++i)
			std::memcpy(&values[i], reads.at(0).data() + i * stride, sizeof(Value));
	return result;
}

template <typename Value>
void writeArray(Writes& writes, const Place& place, VkDeviceSize stride, std::span<const Product> products, Value (*value)(const Product&))
{
	for (size_t i = 0; i < products.size(); ++i)
		writes.addValue(Place{ place.buffer, place.offset + i * stride, place.usage }, value(products[i]));
}

void placeImplicitly(const Operation& operation, std::span<Product> products)
{
	const VkDeviceSize alignment = alignmentOf(kindOf(operation.input));
	VkDeviceAddress next = operation.info.dstImplicitData;
	if (next == 0)
	{
		operation.report().violation("dst-implicit-null", "{}: dstImplicitData is 0, right is the memory of the results", operation.name());
		std::fill(products.begin(), products.end(), Product{});
		return;
	}
	checkAlignment(operation, "dst-implicit", next, alignment, "dstImplicitData");
	VkDeviceSize used = 0;
	for (Product& product : products)
		if (product.bytes)
		{
			used = alignUp(used, alignment);
			product.address = next + used;
			used += product.bytes;
		}
	// Not what is used, but what the query said: the program does not know what will be used. More than that takes another violation.
	const bool moves = operation.input.type() == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV;
	const VkDeviceSize reserved = moves ? used : std::max(used, operation.sizes.structures);
	if (moves && used > operation.input.move.maxMovedBytes)
		operation.report().violation("max-moved-bytes", "{}: results have {} bytes, maxMovedBytes is {}", operation.name(), used,
									 operation.input.move.maxMovedBytes);
	if (!placeOf(operation, "dst-implicit", next, reserved, kStorageUsage, "dstImplicitData"))
		for (Product& product : products)
			product = {};
	operation.context.hazards.write(next, reserved, "dstImplicitData");
	const Span results = { next, next + reserved };
	if (results.overlaps({ operation.info.scratchData, operation.info.scratchData + operation.sizes.scratch }))
		operation.report().violation("scratch-overlap", "{}: dstImplicitData at {:#x} with {} bytes overlaps scratchData at {:#x} with {}",
									 operation.name(), next, reserved, operation.info.scratchData, operation.sizes.scratch);
}

void checkOverlaps(const Operation& operation, std::span<const Product> products)
{
	std::vector<Span> spans;
	for (const Product& product : products)
		if (product.bytes && product.address)
			spans.push_back({ product.address, product.address + product.bytes });
	std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.first < b.first; });
	const Span scratch = { operation.info.scratchData, operation.info.scratchData + operation.sizes.scratch };
	for (size_t i = 0; i < spans.size(); ++i)
	{
		if (i > 0 && spans[i].overlaps(spans[i - 1]))
			operation.report().violation("destinations-overlap", "{}: results at {:#x} (ends {:#x}) and {:#x} overlap", operation.name(),
										 spans[i - 1].first, spans[i - 1].end, spans[i].first);
		if (spans[i].overlaps(scratch))
			operation.report().violation("scratch-overlap", "{}: a result at {:#x} overlaps scratchData at {:#x} with {} bytes", operation.name(),
										 spans[i].first, scratch.first, operation.sizes.scratch);
	}
}

VkResult placeExplicitly(const Operation& operation, std::span<Product> products)
{
	const auto& array = operation.info.dstAddressesArray;
	if (array.deviceAddress == 0)
	{
		operation.report().violation("dst-addresses-null", "{}: dstAddressesArray is 0 with explicit destinations", operation.name());
		std::fill(products.begin(), products.end(), Product{});
		return VK_SUCCESS;
	}
	const auto place = arrayPlace(operation, "dst-addresses", array, 8, static_cast<uint32_t>(products.size()), kStorageUsage);
	std::vector<VkDeviceAddress> addresses(products.size());
	if (place)
		if (const VkResult result = readArray(operation, *place, array.stride, addresses); result != VK_SUCCESS)
			return result;
	const VkDeviceSize alignment = alignmentOf(kindOf(operation.input));
	for (size_t i = 0; i < products.size(); ++i)
	{
		Product& product = products[i];
		product.address = addresses[i];
		if (!product.bytes || !place)
			product = {};
		if (!product.bytes)
			continue;
		const std::string text = fmt::format("result {}", i);
		checkAlignment(operation, "destination", product.address, alignment, text);
		if (!placeOf(operation, "destination", product.address, product.bytes, kStorageUsage, text))
			product = {};
	}
	for (const Product& product : products)
		operation.context.hazards.write(product.address, product.bytes, "a destination");
	checkOverlaps(operation, products);
	return VK_SUCCESS;
}

// Explicit destinations: the sizes are those of the places, if given at all.
VkResult checkGivenSizes(const Operation& operation, std::span<const Product> products)
{
	const auto& array = operation.info.dstSizesArray;
	const auto place = arrayPlace(operation, "dst-sizes", array, 4, static_cast<uint32_t>(products.size()), 0);
	std::vector<uint32_t> sizes(products.size());
	if (!place)
		return VK_SUCCESS;
	const VkResult result = readArray(operation, *place, array.stride, sizes);
	for (size_t i = 0; result == VK_SUCCESS && i < products.size(); ++i)
		if (sizes[i] < products[i].bytes)
			operation.report().violation("destination-too-small", "{}: result {} has {} bytes, dstSizesArray gives it {}", operation.name(), i,
										 products[i].bytes, sizes[i]);
	return result;
}

}  // namespace

VkResult placeProducts(const Operation& operation, std::span<Product> products)
{
	const VkClusterAccelerationStructureOpModeNV mode = operation.input.mode();
	const auto count = static_cast<uint32_t>(products.size());
	const VkStridedDeviceAddressRegionKHR &addresses = operation.info.dstAddressesArray, &sizes = operation.info.dstSizesArray;
	if (mode == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_EXPLICIT_DESTINATIONS_NV)
	{
		const VkResult result = placeExplicitly(operation, products);
		return result == VK_SUCCESS && sizes.deviceAddress ? checkGivenSizes(operation, products) : result;
	}
	Writes writes;
	const VkDeviceSize alignment = alignmentOf(kindOf(operation.input));
	if (mode == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV)
		for (Product& product : products)
			product.bytes = alignUp(product.bytes, alignment);
	else
	{
		placeImplicitly(operation, products);
		if (addresses.deviceAddress)
			if (const auto place = arrayPlace(operation, "dst-addresses", addresses, 8, count, kStorageUsage))
				writeArray<VkDeviceAddress>(writes, *place, addresses.stride, products, [](const Product& product) { return product.address; });
	}
	if (sizes.deviceAddress)
	{
		if (const auto place = arrayPlace(operation, "dst-sizes", sizes, 4, count, 0))
			writeArray<uint32_t>(writes, *place, sizes.stride, products, [](const Product& product) { return uint32_t(product.bytes); });
	}
	else if (mode == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV)
		operation.report().violation("dst-sizes-null", "{}: dstSizesArray is 0, sizes are all that this mode makes", operation.name());
	return operation.context.write(writes);
}

VkResult writeRecords(const Operation& operation, std::span<const std::pair<VkDeviceAddress, std::vector<std::byte>>> records, bool structures_placed)
{
	Writes writes;
	uint64_t bytes = 0;
	for (const auto& [address, record] : records)
	{
		if (!structures_placed)
			operation.device().structures.memoryEnded(operation.device(), address, address + record.size());
		if (const auto place = operation.device().addresses.find(address, record.size(), kStorageUsage))
			writes.add(*place, record);
		bytes += record.size();
	}
	operation.report().count(fmt::format("{} bytes", operation.name()), bytes);
	return operation.context.write(writes);
}

VkResult readRecords(const Operation& operation, std::span<const VkDeviceAddress> addresses, RecordKind kind, const ReferenceNames& names,
					 std::vector<std::optional<std::vector<std::byte>>>& records)
{
	static constexpr const char* kKinds[] = { "bottom-level structure", "cluster", "template" };
	const char* wanted = kKinds[size_t(kind)];
	records.assign(addresses.size(), std::nullopt);
	const auto complain = [&](size_t i, const std::string& is) {
		operation.report().violation(names.wrong, "{}: reference {} to {:#x} is {}, right is a {} that was built there", operation.name(), i,
									 addresses[i], is, wanted);
	};
	std::vector<std::pair<size_t, size_t>> numbers;  // of the reference, of the read
	Reads heads;
	for (size_t i = 0; i < addresses.size(); ++i)
		if (addresses[i] % alignmentOf(kind) != 0)
			checkAlignment(operation, names.alignment, addresses[i], alignmentOf(kind), fmt::format("reference {}", i));
		else if (const auto place = operation.device().addresses.find(addresses[i], sizeof(RecordHead), 0))
			numbers.emplace_back(i, heads.add(*place, sizeof(RecordHead)));
		else
			complain(i, "in no live buffer");
	if (const VkResult result = operation.context.read(heads); result != VK_SUCCESS)
		return result;
	Reads bodies;
	std::vector<std::pair<size_t, size_t>> whole;
	for (const auto& [i, number] : numbers)
	{
		const auto head = headOf(heads.at(number), addresses[i]);
		const auto place = head ? operation.device().addresses.find(addresses[i], head->bytes, 0) : std::nullopt;
		if (!place)
			complain(i, "nothing that a cluster command wrote");
		else if (head->kind != kind)
			complain(i, fmt::format("a {}", kKinds[std::min<size_t>(size_t(head->kind), 2)]));
		else
		{
			operation.context.hazards.read(addresses[i], head->bytes, wanted);
			whole.emplace_back(i, bodies.add(*place, head->bytes));
		}
	}
	if (const VkResult result = operation.context.read(bodies); result != VK_SUCCESS)
		return result;
	for (const auto& [i, number] : whole)
		if (isIntact(bodies.at(number)))
			records[i].emplace(bodies.at(number).begin(), bodies.at(number).end());
		else
			complain(i, fmt::format("a {} that something else was written over", wanted));
	return VK_SUCCESS;
}

}  // namespace tessera::layer
