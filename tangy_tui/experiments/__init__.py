"""The paper's scenarios run again, and what came out beside what it printed."""
