"""What the packages ``babybench`` and ``mimoEnv`` are made of; import those."""
