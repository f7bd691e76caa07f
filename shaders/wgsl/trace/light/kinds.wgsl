// Which kinds of light a text has code for. The host replaces this module by one that says what the
// scene has.

const LIGHTS_HAVE_AREAS: bool = true;
const LIGHTS_HAVE_PUNCTUAL: bool = true;
const LIGHTS_HAVE_ENVIRONMENT: bool = true;
