// Scenes with instances. Others have trace/world/levels_one instead, and no code for them.

const WORLD_HAS_INSTANCES: bool = true;
