// Scenes without instances.

const WORLD_HAS_INSTANCES: bool = false;
