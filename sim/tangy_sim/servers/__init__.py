"""The wires of a simulated robot, as real devices speak: rosbridge, SCIP and MJPEG."""
