"""The execution monitoring sub-system (Fig. 1, below): detection, diagnosis, recovery."""
