#include "app/commands.h"
#include "app/scene_load.h"
#include "base/log.h"
#include "output/mesh_glb.h"

namespace tessera
{

Status exportCommand(const CommandLine& line)
{
	if (!line.output.ends_with(".glb"))
		return fail(ExitCode::Usage, "export: -o {} must name a .glb file", line.output.empty() ? "(missing)" : line.output);
	if (!line.base)
		return fail(ExitCode::Usage, "export: this version writes only the scene as loaded, before tessellation: add --base");
	TRY_ASSIGN(const ImportedScene scene, importScene(line.scene, line.options));
	for (const std::string& warning : scene.warnings)
		logWarning("{}", warning);
	TRY(writeSceneGlb(line.output, scene));
	logInfo("wrote {}", line.output);
	return {};
}

}  // namespace tessera
