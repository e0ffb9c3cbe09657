"""MIMo 3 on the engine: what differs from MIMo 2. The package ``mimo_infant`` shows it under the names of MIMo 3."""
