"""MIMo's own environments: tasks with goals, environments without a task, tests of muscles."""
