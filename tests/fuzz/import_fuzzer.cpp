// libFuzzer target: any bytes as a .gltf or .glb file. See tests/fuzz/README.md.
#include "import_check.h"
#include "mutate.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t most);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t most, unsigned seed);

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
	const std::string wrong = tessera::test::checkImport(std::as_bytes(std::span(data, size)));
	if (wrong.empty())
		return 0;
	std::fprintf(stderr, "a promise is broken: %s\n", wrong.c_str());
	std::abort();
}

size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t most, unsigned seed)
{
	const std::vector<uint8_t> changed = tessera::test::mutateGltf({ data, size }, most, seed, LLVMFuzzerMutate);
	std::memcpy(data, changed.data(), changed.size());
	return changed.size();
}
