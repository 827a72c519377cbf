"""Protocol servers of a simulated robot: rosbridge, SCIP and MJPEG."""
