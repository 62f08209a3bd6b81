// Structures that extend others: finding one in a chain, and taking one out for as long as a call lasts.
#pragma once
#include <vulkan/vulkan.h>

namespace tessera::layer
{

template <typename Struct>
Struct* findInChain(const void* first, VkStructureType type)
{
	for (auto* entry = static_cast<const VkBaseInStructure*>(first); entry; entry = entry->pNext)
		if (entry->sType == type)
			return reinterpret_cast<Struct*>(const_cast<VkBaseInStructure*>(entry));
	return nullptr;
}

// Takes the first structure of a type out of the chain behind `head`, and puts it back at the end of its life: the layers and drivers below have
// never heard of it, and a copy of a chain would need to know the size of everything in it.
class TakenOut
{
public:
	TakenOut(const void* head, VkStructureType type)
	{
		auto* before = static_cast<VkBaseOutStructure*>(const_cast<void*>(head));
		while (before && before->pNext && before->pNext->sType != type)
			before = before->pNext;
		if (!before || !before->pNext)
			return;
		before_ = before;
		taken_ = before->pNext;
		before->pNext = taken_->pNext;
	}
	~TakenOut()
	{
		if (before_)
			before_->pNext = taken_;
	}
	TakenOut(const TakenOut&) = delete;
	TakenOut& operator=(const TakenOut&) = delete;

private:
	VkBaseOutStructure *before_ = nullptr, *taken_ = nullptr;
};

}  // namespace tessera::layer
