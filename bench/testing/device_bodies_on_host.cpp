// The bodies of scenes on the host's model of a device.
#include "bench/stages/device_bodies.cu"
