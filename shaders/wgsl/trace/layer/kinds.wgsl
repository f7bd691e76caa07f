// Which layers of surfaces a text has code for. The host replaces this module by one that says what the
// scene has.

const LAYERS_HAVE_COATS: bool = true;
const LAYERS_HAVE_GLASS: bool = true;
// Colours of vertices.
const LAYERS_HAVE_COLORS: bool = true;
