#include "layers/cluster_mistakes.h"

#include "layers/layer_report.h"

#include <gtest/gtest.h>

namespace tessera::test
{

std::vector<VkDeviceAddress> Stage::built()
{
	kept.push_back(std::make_unique<ClusterCommand>(clusters()));
	kept.back()->run();
	return kept.back()->resultAddresses();
}

VkDeviceAddress Stage::madeTemplate(const std::function<void(TemplateInfo&)>& change)
{
	kept.push_back(std::make_unique<ClusterCommand>(buildTemplate(gpu, data, 100)));
	if (change)
		change(argument<TemplateInfo>(*kept.back()));
	kept.back()->run();
	return kept.back()->resultAddresses()[0];
}

ClusterCommand Stage::bottomLevels(const std::vector<VkDeviceAddress>& references)
{
	lists = std::make_unique<Buffer>(gpu, references);
	return buildBottomLevels(gpu, *lists, { static_cast<uint32_t>(references.size()) });
}

Mistake wrongCluster(const Change& change)
{
	return [=](Stage& stage) {
		ClusterCommand command = stage.clusters();
		change(command);
		command.run();
	};
}

Mistake wrongTemplate(const std::function<void(TemplateInfo&)>& change)
{
	return [=](Stage& stage) {
		stage.madeTemplate(change);
	};
}

Mistake wrongInstance(const Change& change)
{
	return [=](Stage& stage) {
		ClusterCommand command = stage.instances(stage.madeTemplate());
		change(command);
		command.run();
	};
}

Mistake wrongBottomLevel(const Change& change)
{
	return [=](Stage& stage) {
		ClusterCommand command = stage.bottomLevels(stage.built());
		change(command);
		command.run();
	};
}

void replace(std::unique_ptr<Buffer>& buffer, Gpu& gpu, VkBufferUsageFlags lacking)
{
	auto other = std::make_unique<Buffer>(gpu, buffer->size, Buffer::kAll & ~lacking);
	std::memcpy(other->data, buffer->data, buffer->size);
	buffer = std::move(other);
}

void expectNamed(const char* violation, const Mistake& mistake)
{
	const LayerReport report = underTheLayer([&](Gpu& gpu) {
		Stage stage(gpu);
		mistake(stage);
	});
	if (!report.device)
		GTEST_SKIP() << "the device cannot trace rays";
	EXPECT_TRUE(report.violations.contains(violation)) << violation;
	for (const auto& [name, text] : report.texts)
		EXPECT_EQ(name, violation) << text;
}

}  // namespace tessera::test
